// Texture lookups through TextureRefs. Functions only.
#ifndef LIB_TEXTURES_GLSL
#define LIB_TEXTURES_GLSL
#include "shaders/lib/scene.glsl"
#include "format/texture_tile.h"

// Without non-uniform descriptor indexing, which software Vulkan lacks: one constant index a case.
#define TEXTURE_PAGE_CASE(index) case index: if (index < kUsedTexturePages) size = vec2(textureSize(texture_pages[index], 0)); break;
vec2 texturePageSize(uint page)
{
    vec2 size = vec2(1.0);
    switch (int(page))
    {
        TEXTURE_PAGE_CASE(0) TEXTURE_PAGE_CASE(1) TEXTURE_PAGE_CASE(2) TEXTURE_PAGE_CASE(3)
        TEXTURE_PAGE_CASE(4) TEXTURE_PAGE_CASE(5) TEXTURE_PAGE_CASE(6) TEXTURE_PAGE_CASE(7)
        TEXTURE_PAGE_CASE(8) TEXTURE_PAGE_CASE(9) TEXTURE_PAGE_CASE(10) TEXTURE_PAGE_CASE(11)
        TEXTURE_PAGE_CASE(12) TEXTURE_PAGE_CASE(13) TEXTURE_PAGE_CASE(14) TEXTURE_PAGE_CASE(15)
    }
    return size;
}
#undef TEXTURE_PAGE_CASE

#define TEXTURE_PAGE_CASE(index) case index: if (index < kUsedTexturePages) texel = textureLod(texture_pages[index], uvw, lod); break;
vec4 sampleTexturePage(uint page, vec3 uvw, float lod)
{
    vec4 texel = vec4(1.0);
    switch (int(page))
    {
        TEXTURE_PAGE_CASE(0) TEXTURE_PAGE_CASE(1) TEXTURE_PAGE_CASE(2) TEXTURE_PAGE_CASE(3)
        TEXTURE_PAGE_CASE(4) TEXTURE_PAGE_CASE(5) TEXTURE_PAGE_CASE(6) TEXTURE_PAGE_CASE(7)
        TEXTURE_PAGE_CASE(8) TEXTURE_PAGE_CASE(9) TEXTURE_PAGE_CASE(10) TEXTURE_PAGE_CASE(11)
        TEXTURE_PAGE_CASE(12) TEXTURE_PAGE_CASE(13) TEXTURE_PAGE_CASE(14) TEXTURE_PAGE_CASE(15)
    }
    return texel;
}
#undef TEXTURE_PAGE_CASE

/// The hardware sampler repeats; clamping and mirroring bend the coordinate before it.
/// @param size of the level that is read, texels: half a texel keeps bilinear footprints inside
float wrapCoordinate(float x, uint mode, float size)
{
    if (mode == kWrapMirror)
        x = 1.0 - abs(1.0 - (x - 2.0 * floor(0.5 * x)));
    return mode == kWrapRepeat ? x : clamp(x, 0.5 / size, 1.0 - 0.5 / size);
}

/// Texels of level 0.
uvec2 textureTexels(TextureRef ref) { return uvec2(ref.size & 0xffffu, ref.size >> 16); }

/// Mip level whose texels are as large as a square of side `footprint` in surface coordinates.
float levelFor(TextureRef ref, float footprint)
{
    vec2 size = vec2(textureTexels(ref));
    float area = abs(ref.u_row.x * ref.v_row.y - ref.u_row.y * ref.v_row.x) * size.x * size.y;
    return log2(max(1.0, footprint * sqrt(area)));
}

/// One level of a tile, bilinearly filtered; what lies around it repeats.
vec4 sampleTileLevel(TextureRef ref, vec2 st, uint level)
{
    uvec2 origin = uvec2(ref.origin & 0xffffu, ref.origin >> 16), size = textureTexels(ref);
    vec2 first = vec2(tileLevelX(origin.x, size.x, level), tileLevelY(origin.y, size.y, level)) + float(kTileBorder);
    vec2 texels = vec2(levelSide(size.x, level), levelSide(size.y, level));
    return sampleTexturePage(ref.page, vec3((first + fract(st) * texels) / texturePageSize(ref.page), float(ref.layer)), 0.0);
}

vec4 sampleTile(TextureRef ref, vec2 st, float level)
{
    uvec2 size = textureTexels(ref);
    level = min(level, float(findMSB(max(size.x, size.y))));
    uint fine = uint(level);
    vec4 texel = sampleTileLevel(ref, st, fine);
    return level > float(fine) ? mix(texel, sampleTileLevel(ref, st, fine + 1u), level - float(fine)) : texel;
}

/// One texture around the surface coordinates. @param footprints how far around, in units of uv0 and uv1; 0: a point
vec4 sampleTexture(uint ref_index, vec2 uv0, vec2 uv1, vec2 footprints)
{
    TextureRef ref = texture_refs[ref_index];
    vec3 uv = vec3((ref.sampling & kSampleUv1) != 0u ? uv1 : uv0, 1.0);
    float footprint = (ref.sampling & kSampleUv1) != 0u ? footprints.y : footprints.x;
    float level = footprint > 0.0 ? levelFor(ref, footprint) : 0.0;
    vec2 st = vec2(dot(ref.u_row, uv), dot(ref.v_row, uv));
    if ((ref.sampling & 31u) != kWrapRepeat) // it does not repeat, or is not filtered
    {
        vec2 size = vec2(textureTexels(ref));
        vec2 coarse = max(floor(size * exp2(-ceil(level))), vec2(1.0)); // of the coarser of two levels that are blended
        st = vec2(wrapCoordinate(st.x, ref.sampling & 3u, coarse.x), wrapCoordinate(st.y, (ref.sampling >> 2) & 3u, coarse.y));
        if ((ref.sampling & kSampleNearest) != 0u)
            st = (floor(st * size) + 0.5) / size;
    }
    if (hasFeature(kFeatureTiles) && (ref.sampling & kSampleTile) != 0u)
        return sampleTile(ref, st, level);
    return sampleTexturePage(ref.page, vec3(st, float(ref.layer)), level);
}

/// The vector that a normal map stores there, before its scale; about unit length.
vec3 sampleNormal(uint ref_index, vec2 uv0, vec2 uv1, vec2 footprints)
{
    vec3 n = sampleTexture(ref_index, uv0, uv1, footprints).xyz * 2.0 - 1.0;
    if ((texture_refs[ref_index].sampling & kSampleNormalXy) != 0u)
        n.z = sqrt(max(0.0, 1.0 - dot(n.xy, n.xy)));
    return n;
}

#endif
