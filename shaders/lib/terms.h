// The terms a picture is the sum of: which light paths each of them owns. Shared by C++ and GLSL.
// E the eye, L a light, S smooth delta lobes, D the diffuse lobe, G specular lobes that are not delta; x is the first
// vertex after E S* that the path leaves through D or G. Thin smooth walls that are passed straight are no vertices.
#ifndef LIB_TERMS_H
#define LIB_TERMS_H
#include "shaders/lib/choice.h"

GPU_NAMESPACE_BEGIN

#define GPU_TERMS(X) \
    X(kTermAll, 0u, "all") \
    X(kTermEmission, 1u, "emission") /* L S* E */ \
    X(kTermDirect, 2u, "direct")     /* L (D or G) S* E */ \
    X(kTermCaustics, 3u, "caustics") /* L S+ D S* E */ \
    X(kTermIndirect, 4u, "indirect") /* L (S, G, D)* (D or G) S* D S* E */ \
    X(kTermGlossy, 5u, "glossy")     /* L ... G S* E that is not direct */
GPU_TERMS(GPU_CHOICE_CONSTANT)

GPU_NAMESPACE_END
#endif
