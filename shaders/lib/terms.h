// The terms a picture is the sum of: which light paths each of them owns. Shared by C++ and GLSL.
// E the eye, L a light, S smooth delta lobes, D the diffuse lobe, G specular lobes that are not delta; x is the first
// vertex after E S* that the path leaves through D or G. Thin smooth walls that are passed straight are no vertices.
#ifndef LIB_TERMS_H
#define LIB_TERMS_H
#include "format/gpu_types.h"

GPU_NAMESPACE_BEGIN

GPU_CONST uint kTermAll = 0u;
GPU_CONST uint kTermEmission = 1u; // L S* E
GPU_CONST uint kTermDirect = 2u;   // L (D or G) S* E
GPU_CONST uint kTermCaustics = 3u; // L S+ D S* E
GPU_CONST uint kTermIndirect = 4u; // L (S, G, D)* (D or G) S* D S* E
GPU_CONST uint kTermGlossy = 5u;   // L ... G S* E that is not direct

GPU_NAMESPACE_END
#endif
