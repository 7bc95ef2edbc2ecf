// A surface's material at one point, its textures applied. Functions only.
#ifndef LIB_MATERIAL_GLSL
#define LIB_MATERIAL_GLSL
#include "shaders/lib/surface.glsl"

struct SurfaceMaterial // the material's values at one point, textures applied
{
    vec3 base_color;
    float metallic;
    float roughness;
    float transmission;
    float specular;
    vec3 specular_color;
    float ior;
    vec3 emission; // W/(m^2 sr)
    uint flags;    // kMaterial*
    float clearcoat;
    float clearcoat_roughness;
    vec3 sheen_color;
    float sheen_roughness;
    float anisotropy;
    vec2 grain;      // unit: the direction of anisotropy in tangent and bitangent
    float iridescence;
    float iridescence_ior;
    float iridescence_thickness; // nm
    float dispersion;
    float diffuse_transmission;
    vec3 diffuse_transmission_color;
};

vec3 surfaceEmission(uint material, vec2 uv0, vec2 uv1, Footprints footprints)
{
    vec3 emission = loadMaterial(material).emission;
    uint ref = loadMaterial(material).emissive_texture;
    if (hasFeature(kFeatureEmissiveMaps) && ref != kNone && emission != vec3(0.0))
        emission *= sampleTexture(ref, uv0, uv1, footprints).rgb;
    return emission;
}

/// What a texture that not every scene has multiplies a factor with; 1 without it.
vec4 rareTexel(uint ref, Surface s) { return hasFeature(kFeatureRareMaps) && ref != kNone ? sampleTexture(ref, s.uv0, s.uv1, s.footprints) : vec4(1.0); }

/// The layers that few materials have; 0 where the scene has none.
void addRareLayers(Surface s, inout SurfaceMaterial m)
{
    m.clearcoat = m.sheen_roughness = m.anisotropy = m.iridescence = m.dispersion = m.diffuse_transmission = 0.0;
    m.clearcoat_roughness = 0.0;
    m.sheen_color = m.diffuse_transmission_color = vec3(0.0);
    m.grain = vec2(1.0, 0.0);
    m.iridescence_ior = m.iridescence_thickness = 1.0;
    if (hasFeature(kFeatureClearcoat))
    {
        m.clearcoat = loadMaterial(s.material).clearcoat * rareTexel(loadMaterial(s.material).clearcoat_texture, s).r;
        m.clearcoat_roughness = loadMaterial(s.material).clearcoat_roughness * rareTexel(loadMaterial(s.material).clearcoat_roughness_texture, s).g;
    }
    if (hasFeature(kFeatureSheen))
    {
        m.sheen_color = loadMaterial(s.material).sheen_color * rareTexel(loadMaterial(s.material).sheen_color_texture, s).rgb;
        m.sheen_roughness = loadMaterial(s.material).sheen_roughness * rareTexel(loadMaterial(s.material).sheen_roughness_texture, s).a;
    }
    if (hasFeature(kFeatureAnisotropy))
    {
        vec3 texel = loadMaterial(s.material).anisotropy_texture == kNone ? vec3(1.0, 0.5, 1.0) : rareTexel(loadMaterial(s.material).anisotropy_texture, s).rgb;
        float turn = loadMaterial(s.material).anisotropy_rotation;
        vec2 direction = texel.xy * 2.0 - 1.0;
        m.grain = mat2(cos(turn), sin(turn), -sin(turn), cos(turn)) * direction;
        m.anisotropy = loadMaterial(s.material).anisotropy * texel.z;
    }
    if (hasFeature(kFeatureIridescence))
    {
        m.iridescence = loadMaterial(s.material).iridescence * rareTexel(loadMaterial(s.material).iridescence_texture, s).r;
        m.iridescence_ior = loadMaterial(s.material).iridescence_ior;
        m.iridescence_thickness = mix(loadMaterial(s.material).iridescence_thickness_minimum, loadMaterial(s.material).iridescence_thickness_maximum,
                                      rareTexel(loadMaterial(s.material).iridescence_thickness_texture, s).g);
    }
    if (hasFeature(kFeatureDispersion))
        m.dispersion = loadMaterial(s.material).dispersion;
    if (hasFeature(kFeatureDiffuseTransmission))
    {
        m.diffuse_transmission = loadMaterial(s.material).diffuse_transmission * rareTexel(loadMaterial(s.material).diffuse_transmission_texture, s).a;
        m.diffuse_transmission_color =
            loadMaterial(s.material).diffuse_transmission_color * rareTexel(loadMaterial(s.material).diffuse_transmission_color_texture, s).rgb;
    }
}

/// The material of gpu_scene.h at one point of which base colour, metallic and roughness are known.
SurfaceMaterial materialAt(Surface s, vec3 base_color, float metallic, float roughness)
{
    SurfaceMaterial m;
    m.flags = loadMaterial(s.material).flags;
    m.base_color = base_color;
    m.metallic = metallic;
    m.roughness = roughness;
    m.ior = loadMaterial(s.material).ior;
    m.emission = surfaceEmission(s.material, s.uv0, s.uv1, s.footprints);
    m.transmission = loadMaterial(s.material).transmission * rareTexel(loadMaterial(s.material).transmission_texture, s).r;
    m.specular = loadMaterial(s.material).specular * rareTexel(loadMaterial(s.material).specular_texture, s).a;
    m.specular_color = loadMaterial(s.material).specular_color * rareTexel(loadMaterial(s.material).specular_color_texture, s).rgb;
    addRareLayers(s, m);
    return m;
}

/// The same where nothing is known yet.
SurfaceMaterial materialAt(Surface s)
{
    vec3 base_color = loadMaterial(s.material).base_color * s.color.rgb;
    float metallic = loadMaterial(s.material).metallic, roughness = loadMaterial(s.material).roughness;
    uint ref = loadMaterial(s.material).base_color_texture;
    // Coarse levels mix in the colours of texels that are cut away, where any are.
    bool cut_away = (loadMaterial(s.material).flags & (kMaterialAlphaMask | kMaterialAlphaBlend)) != 0u;
    if (hasFeature(kFeatureBaseColorMaps) && ref != kNone)
    {
        Footprints footprints = s.footprints;
        if (cut_away)
            footprints = kPoint;
        base_color *= sampleTexture(ref, s.uv0, s.uv1, footprints).rgb;
    }
    ref = loadMaterial(s.material).metallic_roughness_texture;
    if (hasFeature(kFeatureMetallicRoughnessMaps) && ref != kNone)
    {
        vec4 texel = sampleTexture(ref, s.uv0, s.uv1, s.footprints);
        roughness *= texel.g;
        metallic *= texel.b;
    }
    return materialAt(s, base_color, metallic, roughness);
}

bool emits(Surface s) { return s.front || (loadMaterial(s.material).flags & kMaterialDoubleSided) != 0u; }

#endif
