// Which terms a pixel's light has in the scene; for kernels with SceneGpu::transportConstants(). Functions only.
#ifndef LIB_LIGHT_TERMS_GLSL
#define LIB_LIGHT_TERMS_GLSL
#include "shaders/lib/scene.glsl"

// Constant when the pipeline is built: terms that no surface of the scene sends are neither filtered nor remembered (runtime/frame/plan.cpp).
const bool kSceneHasGlossy = (kSceneFeatures & kFeatureSpecular) != 0u;
const bool kSceneHasCaustics = (kSceneFeatures & kFeatureDeltaLobes) != 0u;

/// @param term in the order of PixelHistory
bool sceneHas(uint term) { return term < 2u || (term == 2u ? kSceneHasGlossy : kSceneHasCaustics); }

#endif
