// Incident light of irradiance samples by direction, as real spherical harmonics of order 4 (bands 0 to 3).
// Shared by runtime/stages/gather.cpp, glossy_lobe.cpp and shaders/**.
#ifndef SHADERS_HARMONICS_H
#define SHADERS_HARMONICS_H
#include "shaders/rays/rays.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kHarmonicsCount = 16u; // coefficients of a channel

// What is projected is L(w) cos(w, n), radiance times cosine, not radiance: rays come by the density cos/pi, and dividing by
// it would give a ray near the horizon any weight (the variance of radiance's own coefficients is infinite), while the BRDF's
// integral wants the cosine anyhow. It also leaves no edge at the horizon for so few bands to ring at. Band 0 is then the
// irradiance E, which Sample has. The others are stored relative to it,
//   h_lm = 1/E Int L(w) cos(w, n) B_lm(w) dw,    B_lm = sqrt(4 pi / (2 l + 1)) Y_lm,
// which lie in [-1, 1] for |B_lm| <= 1 and L >= 0: a byte holds one.
struct SampleHarmonics
{
    uint words[12]; // snorm8: four words of red, of green, of blue; the sixteenth byte of each is none
};
GPU_SIZE(SampleHarmonics, 48);

// The rough reflection lobe seen from one direction, for light given as above: f(w) ~ 1 + sum_l zonal_l P_l(w.d), f times a
// constant that does not matter, d in the plane of the view and the normal, on the mirrored side. zonal_l = (2 l + 1) a^(l (l +
// 1) / 2): the heat kernel on the sphere, which is the smoother the smaller a, and never rings much.
struct GlossyLobe
{
    float height;        // cosine between d and the normal
    float concentration; // a; below 0: more light is from away of d
    float scale;         // directional reflectance = scale f0 + bias f90
    float bias;
};
GPU_SIZE(GlossyLobe, 16);

GPU_CONST uint kLobeRoughnesses = 16u; // of the table, kHarmonicsFrom to 1
GPU_CONST uint kLobeCosines = 32u;     // of the viewer, 0 to 1

// Reflection is from harmonics where roughness is above both, by rays below both, in between by either in part. So few bands
// are good to 1 % or so above the second (they were 8 % too dim at 0.5 under a lamp's light): the band is as wide as it takes
// for that to come on unseen.
GPU_CONST float kHarmonicsFrom = 0.4;
GPU_CONST float kHarmonicsAlone = 0.65;

GPU_NAMESPACE_END
#endif
