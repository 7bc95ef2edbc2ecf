// Lists of choices: #define GPU_THINGS(X) X(kThingOne, 0u, "one") X(kThingTwo, 1u, "two"), numbered from 0. Constants, in
// C++ and GLSL, enumerators and the names of a setting (runtime/choices.h) all follow from one list.
#ifndef LIB_CHOICE_H
#define LIB_CHOICE_H
#include "format/gpu_types.h"

#define GPU_CHOICE_CONSTANT(constant, value, name) GPU_CONST uint constant = value;
#define GPU_CHOICE_ENUMERATOR(constant, value, name) constant = value,

#endif
