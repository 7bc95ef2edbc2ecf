// The bridge that lets one header describe a struct to both C++ and GLSL.
// Every GPU struct uses scalar layout, so C++ members have the offsets that the shader reads.
#ifndef FORMAT_GPU_TYPES_H
#define FORMAT_GPU_TYPES_H

#ifdef __cplusplus
#include <cstddef>
#include <cstdint>

namespace gpu
{
using uint = std::uint32_t;
struct vec2
{
    float x, y;
};
struct vec3
{
    float x, y, z;
};
struct vec4
{
    float x, y, z, w;
};
struct uvec2
{
    uint x, y;
};
struct uvec3
{
    uint x, y, z;
};
struct uvec4
{
    uint x, y, z, w;
};
} // namespace gpu

#define GPU_NAMESPACE_BEGIN \
    namespace gpu \
    {
#define GPU_NAMESPACE_END }
#define GPU_CONST inline constexpr
#define GPU_FUNCTION inline
#define GPU_SIZE(type, bytes) static_assert(sizeof(type) == (bytes), #type " layout changed")
#define GPU_OFFSET(type, member, bytes) static_assert(offsetof(type, member) == (bytes), #type "." #member " has moved")
#else
#define GPU_NAMESPACE_BEGIN
#define GPU_NAMESPACE_END
#define GPU_CONST const
#define GPU_FUNCTION
#define GPU_SIZE(type, bytes)
#define GPU_OFFSET(type, member, bytes)
#endif

#endif
