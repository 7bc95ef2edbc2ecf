#include "compiler/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <optional>
#include <type_traits>

namespace
{
constexpr size_t kMaxZeroElements = size_t(1) << 24; // a few bytes of file must not ask for gigabytes of zeros

Error invalid(int accessor, std::string_view text)
{
    return {ExitCode::kInvalid, fmt::format("{} (/accessors/{})", text, accessor)};
}

/// Calls `use` with a value of the C++ type of a component; false for an unknown type.
template <typename Use>
bool withComponentType(int component_type, const Use& use)
{
    switch (component_type)
    {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        use(int8_t{});
        return true;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        use(uint8_t{});
        return true;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        use(int16_t{});
        return true;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        use(uint16_t{});
        return true;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        use(uint32_t{});
        return true;
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        use(float{});
        return true;
    default:
        return false;
    }
}

/// Copies `count` elements of `components` values from strided bytes, one converter a value.
template <typename From, typename To, typename Convert>
void copyElements(const ByteView& from, size_t count, uint32_t components, To* to, const Convert& convert)
{
    for (size_t i = 0; i < count; ++i)
        for (uint32_t c = 0; c < components; ++c)
        {
            From value;
            std::memcpy(&value, from.data + i * from.stride + c * sizeof(From), sizeof(From));
            to[i * components + c] = convert(value);
        }
}

template <typename From>
float toFloat(From value, bool normalized)
{
    if constexpr (std::is_same_v<From, float>)
        return value;
    else if (!normalized)
        return float(value);
    else
        return std::max(float(value) / float(std::numeric_limits<From>::max()), -1.0f);
}

/// `count` elements at `offset` of a buffer view, or what is wrong with them.
Result<ByteView> elementBytes(const tinygltf::Model& model, int buffer_view, size_t offset, size_t count,
                              size_t element_bytes, int accessor)
{
    Result<ByteView> view = viewBytes(model, buffer_view);
    if (!view)
        return invalid(accessor, view.error().message);
    const size_t stride = view->stride == 0 ? element_bytes : view->stride;
    if (stride < element_bytes)
        return invalid(accessor,
                       fmt::format("its elements of {} bytes overlap: the stride is {}", element_bytes, stride));
    if (offset > view->bytes || (count > 0 && (view->bytes - offset < element_bytes ||
                                               (view->bytes - offset - element_bytes) / stride < count - 1)))
        return invalid(accessor, "an accessor reaches past the end of its buffer view");
    return ByteView{view->data + offset, view->bytes - offset, stride};
}

/// `elements` of a component type, or nothing where it is unknown or `Convert` does not take it.
template <typename To, typename Convert>
std::optional<std::vector<To>> convertElements(const ByteView& elements, size_t count, uint32_t components,
                                               int component_type, const Convert& convert)
{
    std::vector<To> values(count * components);
    bool taken = true;
    const bool known =
        withComponentType(component_type,
                          [&]<typename From>(From)
                          {
                              if constexpr (std::is_invocable_v<Convert, From>)
                                  copyElements<From>(elements, count, components, values.data(), convert);
                              else
                                  taken = false;
                          });
    return known && taken ? std::optional(std::move(values)) : std::nullopt;
}

/// Of indices: unsigned integers only.
struct ToIndex
{
    template <typename From>
    requires std::is_unsigned_v<From> uint32_t operator()(From value) const { return value; }
};

struct ToFloat
{
    bool normalized;

    template <typename From>
    float operator()(From value) const
    {
        return toFloat(value, normalized);
    }
};

/// Replaces the elements that the sparse part of `source` names.
template <typename To, typename Convert>
Status applySparse(const tinygltf::Model& model, int accessor, uint32_t components, const Convert& convert,
                   std::vector<To>& elements)
{
    const tinygltf::Accessor& source = model.accessors[size_t(accessor)];
    const auto& sparse = source.sparse;
    const int index_bytes = tinygltf::GetComponentSizeInBytes(uint32_t(sparse.indices.componentType));
    const size_t element_bytes = components * size_t(tinygltf::GetComponentSizeInBytes(uint32_t(source.componentType)));
    if (sparse.count < 0 || size_t(sparse.count) > source.count || index_bytes <= 0 || sparse.indices.byteOffset < 0 ||
        sparse.values.byteOffset < 0)
        return invalid(accessor, "the sparse part of an accessor is damaged");
    const size_t count = size_t(sparse.count);
    const Result<ByteView> index_view = elementBytes(
        model, sparse.indices.bufferView, size_t(sparse.indices.byteOffset), count, size_t(index_bytes), accessor);
    if (!index_view)
        return index_view.error();
    const Result<ByteView> value_view =
        elementBytes(model, sparse.values.bufferView, size_t(sparse.values.byteOffset), count, element_bytes, accessor);
    if (!value_view)
        return value_view.error();
    const auto indices = convertElements<uint32_t>(*index_view, count, 1, sparse.indices.componentType, ToIndex{});
    const auto values = convertElements<To>(*value_view, count, components, source.componentType, convert);
    if (!indices || !values)
        return invalid(accessor, "the sparse part of an accessor is of a type that is not allowed");
    for (size_t i = 0; i < count; ++i)
    {
        if ((*indices)[i] >= source.count)
            return invalid(accessor, fmt::format("sparse index {} is out of range", (*indices)[i]));
        std::copy_n(values->begin() + ptrdiff_t(i * components), components,
                    elements.begin() + ptrdiff_t((*indices)[i] * size_t(components)));
    }
    return Success{};
}

/// All elements of an accessor: those of its buffer view, or zeros without one, with its sparse part put in.
template <typename To, typename Convert>
Result<std::vector<To>> readElements(const tinygltf::Model& model, int accessor, uint32_t components,
                                     const Convert& convert)
{
    const tinygltf::Accessor& source = model.accessors[size_t(accessor)];
    std::vector<To> elements;
    if (source.bufferView < 0)
    {
        if (source.count > kMaxZeroElements)
            return invalid(accessor, "an accessor without data has too many elements");
        elements.resize(source.count * components);
    }
    else
    {
        const int component_bytes = tinygltf::GetComponentSizeInBytes(uint32_t(source.componentType));
        const auto view = elementBytes(model, source.bufferView, source.byteOffset, source.count,
                                       components * size_t(std::max(component_bytes, 1)), accessor);
        if (!view)
            return view.error();
        auto converted = convertElements<To>(*view, source.count, components, source.componentType, convert);
        if (!converted)
            return invalid(accessor, fmt::format("component type {} is not allowed for {}", source.componentType,
                                                 std::is_same_v<To, float> ? "vertex data" : "indices"));
        elements = std::move(*converted);
    }
    if (source.sparse.isSparse)
        if (const Status status = applySparse(model, accessor, components, convert, elements); !status)
            return status.error();
    return elements;
}

Result<const tinygltf::Accessor*> findAccessor(const tinygltf::Model& model, int accessor)
{
    if (accessor < 0 || size_t(accessor) >= model.accessors.size())
        return Error{ExitCode::kInvalid, fmt::format("accessor {} does not exist", accessor)};
    return &model.accessors[size_t(accessor)];
}
} // namespace

Result<FloatArray> readFloats(const tinygltf::Model& model, int accessor, uint32_t min_components,
                              uint32_t max_components)
{
    const auto found = findAccessor(model, accessor);
    if (!found)
        return found.error();
    const tinygltf::Accessor& source = **found;
    const int components = tinygltf::GetNumComponentsInType(uint32_t(source.type));
    if (components < int(min_components) || components > int(max_components) || source.type == TINYGLTF_TYPE_MAT2)
        return invalid(accessor,
                       fmt::format("an accessor of {} to {} components is expected", min_components, max_components));
    Result<std::vector<float>> values =
        readElements<float>(model, accessor, uint32_t(components), ToFloat{source.normalized});
    if (!values)
        return values.error();
    return FloatArray{uint32_t(components), source.count, std::move(*values)};
}

Result<std::vector<uint32_t>> readIndices(const tinygltf::Model& model, int accessor)
{
    const auto found = findAccessor(model, accessor);
    if (!found)
        return found.error();
    if ((*found)->type != TINYGLTF_TYPE_SCALAR)
        return invalid(accessor, "indices must be a scalar accessor");
    return readElements<uint32_t>(model, accessor, 1, ToIndex{});
}
