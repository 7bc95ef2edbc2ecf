// What a surface is like, as shading points keep it. Functions only.
#ifndef LIB_FINISH_GLSL
#define LIB_FINISH_GLSL

/// 16 bits each. Roughness is rounded up, so that what is no mirror by a hair does not become one.
uint packFinish(float roughness, float metallic)
{
    return uint(ceil(clamp(roughness, 0.0, 1.0) * 65535.0)) | uint(clamp(metallic, 0.0, 1.0) * 65535.0 + 0.5) << 16;
}

/// @return roughness and metallic
vec2 unpackFinish(uint finish) { return unpackUnorm2x16(finish); }

#endif
