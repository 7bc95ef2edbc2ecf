// The fields of a material, each said once: struct, loader, defaults, verifier and FORMAT.md's table follow from this list.
// Shared by C++ and GLSL. A new field is a line at the end, and what reads it.
#ifndef FORMAT_MATERIAL_FIELDS_H
#define FORMAT_MATERIAL_FIELDS_H

// NUMBER(word, type, name, default, least, most, meaning): `word` is its place in units of 4 bytes; every component lies in
// least to most, kUnbounded stands for any finite number. FLAGS(word, name, meaning).
// TEXTURE(word, name, encoding, channels, feature, meaning): index into TextureRefs or kNone; the channels that are read of it
// (alpha coverage apart), and what a scene with it has.
#define MATERIAL_FIELDS(NUMBER, FLAGS, TEXTURE) \
    NUMBER(0, vec3, base_color, 1, 0, 1, "`baseColorFactor`, linear") \
    NUMBER(3, float, alpha, 1, 0, 1, "`baseColorFactor`'s fourth") \
    NUMBER(4, vec3, emission, 0, 0, kUnbounded, \
           "W/(m^2 sr): `emissiveFactor` x `emissiveStrength`, before its texture") \
    NUMBER(7, float, alpha_cutoff, 0.5f, 0, kUnbounded, "`alphaCutoff`") \
    NUMBER(8, float, metallic, 1, 0, 1, "`metallicFactor`") \
    NUMBER(9, float, roughness, 1, 0, 1, "`roughnessFactor`, perceptual: a GGX lobe's width is its square") \
    NUMBER(10, float, normal_scale, 1, -kUnbounded, kUnbounded, "`normalTexture.scale`") \
    NUMBER(11, float, transmission, 0, 0, 1, "`transmissionFactor`") \
    NUMBER(12, float, ior, 1.5f, 0, kUnbounded, "`ior`: at least 1, or 0, which reflects all") \
    NUMBER(13, float, specular, 1, 0, 1, "`specularFactor`") \
    NUMBER(14, vec3, specular_color, 1, 0, kUnbounded, "`specularColorFactor`, linear") \
    NUMBER(17, vec3, absorption, 0, 0, kUnbounded, "1/m: -ln(`attenuationColor`) / `attenuationDistance`") \
    FLAGS(20, flags, "alpha modes, sides, unlit, thin: `kMaterial*`") \
    TEXTURE(21, base_color_texture, kEncodingSrgb, kRed | kGreen | kBlue, kFeatureBaseColorMaps, \
            "RGB, and A as alpha") \
    TEXTURE(22, metallic_roughness_texture, kEncodingLinear, kGreen | kBlue, kFeatureMetallicRoughnessMaps, \
            "G roughness, B metallic") \
    TEXTURE(23, normal_texture, kEncodingNormal, kRed | kGreen | kBlue, kFeatureNormalMaps, "RGB") \
    TEXTURE(24, emissive_texture, kEncodingSrgb, kRed | kGreen | kBlue, kFeatureEmissiveMaps, "RGB") \
    TEXTURE(25, transmission_texture, kEncodingLinear, kRed, kFeatureRareMaps, "R") \
    TEXTURE(26, specular_texture, kEncodingLinear, kAlpha, kFeatureRareMaps, "A") \
    TEXTURE(27, specular_color_texture, kEncodingSrgb, kRed | kGreen | kBlue, kFeatureRareMaps, "RGB") \
    NUMBER(28, float, clearcoat, 0, 0, 1, "`clearcoatFactor`") \
    NUMBER(29, float, clearcoat_roughness, 0, 0, 1, "`clearcoatRoughnessFactor`, perceptual") \
    NUMBER(30, float, clearcoat_normal_scale, 1, -kUnbounded, kUnbounded, "`clearcoatNormalTexture.scale`") \
    NUMBER(31, float, sheen_roughness, 0, 0, 1, "`sheenRoughnessFactor`, perceptual") \
    NUMBER(32, vec3, sheen_color, 0, 0, 1, "`sheenColorFactor`, linear") \
    NUMBER(35, float, anisotropy, 0, 0, 1, "`anisotropyStrength`") \
    NUMBER(36, float, anisotropy_rotation, 0, -kUnbounded, kUnbounded, \
           "`anisotropyRotation`, radians from the tangent to the bitangent") \
    NUMBER(37, float, iridescence, 0, 0, 1, "`iridescenceFactor`") \
    NUMBER(38, float, iridescence_ior, 1.3f, 1, kUnbounded, "`iridescenceIor`, of the film") \
    NUMBER(39, float, iridescence_thickness_minimum, 100, 0, kUnbounded, "`iridescenceThicknessMinimum`, nm") \
    NUMBER(40, float, iridescence_thickness_maximum, 400, 0, kUnbounded, \
           "`iridescenceThicknessMaximum`, nm: the thickness without a texture") \
    NUMBER(41, float, dispersion, 0, 0, kUnbounded, "`dispersion`: 20 / Abbe number") \
    NUMBER(42, float, diffuse_transmission, 0, 0, 1, "`diffuseTransmissionFactor`") \
    NUMBER(43, vec3, diffuse_transmission_color, 1, 0, 1, "`diffuseTransmissionColorFactor`, linear") \
    TEXTURE(46, clearcoat_texture, kEncodingLinear, kRed, kFeatureRareMaps, "R") \
    TEXTURE(47, clearcoat_roughness_texture, kEncodingLinear, kGreen, kFeatureRareMaps, "G") \
    TEXTURE(48, clearcoat_normal_texture, kEncodingNormal, kRed | kGreen | kBlue, kFeatureRareMaps, "RGB") \
    TEXTURE(49, sheen_color_texture, kEncodingSrgb, kRed | kGreen | kBlue, kFeatureRareMaps, "RGB") \
    TEXTURE(50, sheen_roughness_texture, kEncodingLinear, kAlpha, kFeatureRareMaps, "A") \
    TEXTURE(51, anisotropy_texture, kEncodingLinear, kRed | kGreen | kBlue, kFeatureRareMaps, \
            "RG direction, B strength") \
    TEXTURE(52, iridescence_texture, kEncodingLinear, kRed, kFeatureRareMaps, "R") \
    TEXTURE(53, iridescence_thickness_texture, kEncodingLinear, kGreen, kFeatureRareMaps, \
            "G, from minimum to maximum") \
    TEXTURE(54, diffuse_transmission_texture, kEncodingLinear, kAlpha, kFeatureRareMaps, "A") \
    TEXTURE(55, diffuse_transmission_color_texture, kEncodingSrgb, kRed | kGreen | kBlue, kFeatureRareMaps, "RGB")

#define MATERIAL_WORDS 56

#endif
