// Which way a surface faces, in six parts. Functions only.
#ifndef LIB_SIDE_GLSL
#define LIB_SIDE_GLSL

/// The axis that a surface's normal is nearest to, and its sign: 0 to 5.
uint sideOf(vec3 normal)
{
    vec3 size = abs(normal);
    if (size.x >= max(size.y, size.z))
        return normal.x < 0.0 ? 0u : 1u;
    if (size.y >= size.z)
        return normal.y < 0.0 ? 2u : 3u;
    return normal.z < 0.0 ? 4u : 5u;
}

#endif
