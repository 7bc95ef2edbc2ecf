// Density estimation among photons: irradiance at a point from its k nearest photons (Jensen 1996). The kernel declares the
// usamplerBuffers TreeNodes and Photons, sorted as the tree, before it includes this. Functions only.
#ifndef LIB_DENSITY_GLSL
#define LIB_DENSITY_GLSL
#include "shaders/lib/incident.glsl"
#include "shaders/lib/math.glsl"
#include "shaders/lib/photon.glsl"
#include "shaders/lib/random.glsl"
#include "shaders/lib/tree.glsl"

const uint kDensityBins = 32u;
const uint kDensityRefinements = 3u; // histograms, each within one bin of the one before
const uint kDensityOvercrowded = 4096u; // photons visited, after which a full bin is not counted to its end

/// Squared distance of a photon to x, longer off the surface than along it; kInfinity where it lights another surface.
float photonDistance2(Photon photon, vec3 x, vec3 n)
{
    bool counts = dot(n, unpackNormal(photon.direction)) < 0.0 && dot(n, unpackNormal(photon.normal)) > 0.1;
    return counts ? surfaceDistance2(photon.position - x, n) : kInfinity;
}

/// Squared distance within which there are `wanted` photons, or radius2 where there are fewer.
/// @param guess2 of that distance; the search narrows and widens it, but a good guess saves visiting distant photons
///
/// A caustic's focus may hold most photons of the map, and software Vulkan ends a thread's loops after 65535 rounds in all.
/// So bins past the one that completes `wanted` close as soon as it does; where that one is overcrowded, the disc up to it
/// is divided into bins again before all are counted; if it is a narrow rim, it is left out: photons there have almost no weight.
float nearestRadius2(vec3 x, vec3 n, uint photon_count, uint wanted, float radius2, float guess2)
{
    uint bins[kDensityBins];
    float low = 0.0, high = min(guess2, radius2);
    uint below = 0u;
    for (uint refinement = 0u; refinement < kDensityRefinements;)
    {
        for (uint b = 0u; b < kDensityBins; ++b)
            bins[b] = 0u;
        float width = (high - low) / float(kDensityBins);
        uint open = kDensityBins, looked = 0u;
        bool overcrowded = false;
        uint found = below;
        uint i, end;
        beginRanges(photon_count);
        for (;;)
        {
            if (nextRange(x, low + float(open) * width, i, end))
            {
                looked += end - i;
                for (;;)
                {
                    float d2 = photonDistance2(loadPhoton(i), x, n);
                    uint b = d2 < low || d2 >= high ? kDensityBins : min(uint((d2 - low) / width), kDensityBins - 1u);
                    if (b < open)
                    {
                        ++bins[b];
                        ++found;
                    }
                    if (++i == end)
                        break;
                }
                while (found >= wanted && found - bins[open - 1u] >= wanted)
                    found -= bins[--open];
                overcrowded = found >= wanted && looked > max(kDensityOvercrowded, 4u * wanted);
            }
            if (overcrowded || !hasRanges())
                break;
        }
        if (found < wanted)
        {
            if (high >= radius2 || refinement > 0u) // in a refinement: rounding has moved a photon out of its bin
                return high;
            high = min(high * max(2.0, min(16.0, 1.5 * float(wanted) / float(max(found, 1u)))), radius2);
            continue;
        }
        ++refinement;
        high = low + float(open) * width;
        if (overcrowded && open < 8u)
            continue;
        if (overcrowded)
            return high - width;
        if (found <= wanted + wanted / 16u)
            break;
        low = high - width;
        below = found - bins[open - 1u];
    }
    return high;
}

struct DensityEstimate
{
    vec3 irradiance; // W/m^2
    float radius2;   // square metres: what it was taken over
};

/// Irradiance at x from the `wanted` nearest photons within sqrt(radius2), weighted by (1 - d^2/r^2)^2, whose integral
/// over the disc is pi r^2 / 3 (Silverman 1986). There is no minimum count, which would lose
/// the light of dim places. @param guess2 of their squared distance
DensityEstimate estimateIrradiance(vec3 x, vec3 n, uint photon_count, uint wanted, float radius2, float guess2)
{
    float within2 = nearestRadius2(x, n, photon_count, wanted, radius2, guess2);
    vec3 sum = vec3(0.0);
    uint i, end;
    beginRanges(photon_count);
    for (;;)
    {
        if (nextRange(x, within2, i, end))
            for (;;)
            {
                float d2 = photonDistance2(loadPhoton(i), x, n);
                if (d2 < within2)
                    sum += loadPhoton(i).power * square(1.0 - d2 / within2);
                if (++i == end)
                    break;
            }
        if (!hasRanges())
            break;
    }
    return DensityEstimate(sum * (3.0 * kInvPi / within2), within2);
}

/// The photons' light itself. @param random bits
Incident densityLight(vec3 x, vec3 n, uint photon_count, uint wanted, float radius2, float guess2, uint random)
{
    DensityEstimate estimate = estimateIrradiance(x, n, photon_count, wanted, radius2, guess2);
    Reservoir reservoir = Reservoir(random, 0.0, kNone);
    uint i, end;
    beginRanges(photon_count);
    for (;;)
    {
        if (nextRange(x, estimate.radius2, i, end))
            for (;;)
            {
                float d2 = photonDistance2(loadPhoton(i), x, n);
                if (d2 < estimate.radius2)
                    offer(reservoir, luminance(loadPhoton(i).power) * square(1.0 - d2 / estimate.radius2), i);
                if (++i == end)
                    break;
            }
        if (!hasRanges())
            break;
    }
    if (reservoir.chosen == kNone)
        return Incident(estimate.irradiance, -n, estimate.irradiance);
    vec3 color = loadPhoton(reservoir.chosen).power;
    return Incident(estimate.irradiance, unpackNormal(loadPhoton(reservoir.chosen).direction),
                    color * (luminance(estimate.irradiance) / max(luminance(color), 1e-30)));
}

#endif
