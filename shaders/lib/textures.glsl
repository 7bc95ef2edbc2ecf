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

/// What is seen of a texture at once: an ellipse, by two conjugate diameters in surface coordinates.
struct Footprints
{
    mat2 uv0, uv1; // 0: a point
};

const Footprints kPoint = Footprints(mat2(0.0), mat2(0.0));

// Most lookups along an ellipse. What is longer still is blurred across, too.
const float kMostLookups = 8.0;

struct Lookups // along the long axis of an ellipse
{
    vec2 along; // that axis, in coordinates of the texture
    float count;
    float level; // mip level whose texels are as large as one lookup's part of the ellipse
};

/// @param axes in surface coordinates
Lookups lookupsFor(TextureRef ref, mat2 axes)
{
    vec2 size = vec2(textureTexels(ref));
    mat2 turned = mat2(ref.u_row.x, ref.v_row.x, ref.u_row.y, ref.v_row.y) * axes; // columns, as the texture's coordinates
    vec2 a = turned[0] * size, b = turned[1] * size;
    // Its singular values are the lengths of the principal axes, the first singular vector is the direction of the longer.
    float p = a.x * a.x + b.x * b.x, q = a.x * a.y + b.x * b.y, r = a.y * a.y + b.y * b.y;
    float root = length(vec2(p - r, 2.0 * q)), longer = sqrt(max(0.5 * (p + r + root), 0.0));
    float shorter = max(abs(a.x * b.y - a.y * b.x) / max(longer, 1e-20), 1.0);
    vec2 direction = p > r ? vec2(p - r + root, 2.0 * q) : vec2(2.0 * q, r - p + root);
    float norm = length(direction);
    direction = norm > 0.0 ? direction / norm : vec2(1.0, 0.0);
    longer = max(longer, 1.0); // what is smaller than a texel is a texel
    float count = clamp(floor(longer / shorter + 0.5), 1.0, kMostLookups);
    return Lookups(longer * direction / size, count, 0.5 * log2(shorter * max(longer / count, 1.0)));
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

/// One texture around one place.
vec4 sampleLevel(TextureRef ref, vec2 st, float level)
{
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

/// One texture around the surface coordinates: the mean of lookups along the footprint, each as large as that is wide.
vec4 sampleTexture(uint ref_index, vec2 uv0, vec2 uv1, Footprints footprints)
{
    TextureRef ref = texture_refs[ref_index];
    bool second = (ref.sampling & kSampleUv1) != 0u;
    vec3 uv = vec3(second ? uv1 : uv0, 1.0);
    vec2 st = vec2(dot(ref.u_row, uv), dot(ref.v_row, uv));
    if (footprints.uv0 == mat2(0.0) && footprints.uv1 == mat2(0.0))
        return sampleLevel(ref, st, 0.0);
    Lookups lookups = lookupsFor(ref, second ? footprints.uv1 : footprints.uv0);
    vec4 sum = vec4(0.0);
    int left = int(lookups.count); // an integer: Mesa 22.3 takes a loop up to a clamped float once too often
    do // tests at its end: see lib/bvh.glsl why
    {
        --left;
        sum += sampleLevel(ref, st + ((float(left) + 0.5) / lookups.count - 0.5) * lookups.along, lookups.level);
    } while (left > 0);
    return sum / lookups.count;
}
vec4 sampleTexture(uint ref_index, vec2 uv0, vec2 uv1) { return sampleTexture(ref_index, uv0, uv1, kPoint); }

/// The vector that a normal map stores there, before its scale; about unit length.
vec3 sampleNormal(uint ref_index, vec2 uv0, vec2 uv1, Footprints footprints)
{
    vec3 n = sampleTexture(ref_index, uv0, uv1, footprints).xyz * 2.0 - 1.0;
    if ((texture_refs[ref_index].sampling & kSampleNormalXy) != 0u)
        n.z = sqrt(max(0.0, 1.0 - dot(n.xy, n.xy)));
    return n;
}

#endif
