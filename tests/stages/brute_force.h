// Rays against every triangle in double precision: slow, obvious, and honest about what single precision can decide.
#pragma once
#include "shaders/rays/rays.h"

#include <span>
#include <vector>

/// The exact result for one ray and one triangle, with bounds on what the kernels' single precision may
/// differ.
struct Meeting
{
    uint32_t slot; // of the BvhTriangle
    double t;
    double t_error;      // bound; infinite where the ray is (nearly) in the triangle's plane
    double u, v;         // weights of v1 and v2
    double weight_error; // bound on the error of u and v
    bool certain;        // inside by more than rounding can undo, between 0 and t_max likewise
    bool ends_on_it;     // the ray may end in the triangle's plane: shadow rays then may pass
};

/// Every triangle that the ray may meet by what rounding allows, in no order.
std::vector<Meeting> meetings(const gpu::Ray& ray, std::span<const gpu::BvhTriangle> triangles);
