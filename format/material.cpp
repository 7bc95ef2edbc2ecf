#include "format/material.h"

#include <type_traits>

namespace package
{
namespace
{
template <typename T>
T filled(float value)
{
    if constexpr (std::is_same_v<T, gpu::vec3>)
        return {value, value, value};
    else
        return value;
}
} // namespace

gpu::Material defaultMaterial()
{
    using gpu::vec3;
    gpu::Material m{};
#define NUMBER(word, type, name, default_, least, most, meaning) m.name = filled<type>(default_);
#define FLAGS(word, name, meaning) m.name = 0;
#define TEXTURE(word, name, encoding, channels, feature, meaning) m.name = gpu::kNone;
    MATERIAL_FIELDS(NUMBER, FLAGS, TEXTURE)
#undef NUMBER
#undef FLAGS
#undef TEXTURE
    return m;
}
} // namespace package
