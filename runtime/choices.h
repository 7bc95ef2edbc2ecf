// What settings may be chosen by name: every list once. See shaders/lib/choice.h.
#pragma once
#include "shaders/cut/cut.h"
#include "shaders/lib/choice.h"
#include "shaders/lib/terms.h"
#include "shaders/resolve/resolve.h"
#include "shaders/views/views.h"

#include <array>
#include <cstdint>
#include <string_view>

#define LUMICUT_SAMPLES_MODES(X) \
    X(kUniform, 0u, "uniform")      /* seeds follow the number of shading points */ \
    X(kSeeded, 1u, "seeded")        /* seeds follow geometric variation */ \
    X(kKmeans, 2u, "seeded+kmeans") /* the same, then moved by k-means */
enum class SamplesMode : uint32_t
{
    LUMICUT_SAMPLES_MODES(GPU_CHOICE_ENUMERATOR)
};

#define LUMICUT_GLOSSY_MODES(X) \
    X(kRays, 0u, "rays")    /* of every lobe */ \
    X(kHarmonics, 1u, "sh") /* of rough lobes by spherical harmonics in the first frame of a picture, by rays later */
enum class GlossyMode : uint32_t
{
    LUMICUT_GLOSSY_MODES(GPU_CHOICE_ENUMERATOR)
};

struct Choice
{
    std::string_view name;
    uint32_t value; // its place in the list
};

#define LUMICUT_CHOICE(constant, value, name) Choice{name, value},
inline constexpr std::array kCutModes{GPU_CUT_MODES(LUMICUT_CHOICE)};
inline constexpr std::array kSamplesModes{LUMICUT_SAMPLES_MODES(LUMICUT_CHOICE)};
inline constexpr std::array kGlossyModes{LUMICUT_GLOSSY_MODES(LUMICUT_CHOICE)};
inline constexpr std::array kTerms{GPU_TERMS(LUMICUT_CHOICE)};
inline constexpr std::array kViews{GPU_VIEWS(LUMICUT_CHOICE)};
inline constexpr std::array kTonemaps{GPU_TONEMAPS(LUMICUT_CHOICE)};
inline constexpr std::array kOffOn{Choice{"off", 0}, Choice{"on", 1}};
#undef LUMICUT_CHOICE

template <size_t kCount>
consteval bool areNumbered(const std::array<Choice, kCount>& choices)
{
    for (uint32_t i = 0; i < kCount; ++i)
        if (choices[i].value != i)
            return false;
    return true;
}
static_assert(areNumbered(kCutModes) && areNumbered(kSamplesModes) && areNumbered(kGlossyModes) &&
              areNumbered(kTerms) && areNumbered(kViews) && areNumbered(kTonemaps) && areNumbered(kOffOn));
