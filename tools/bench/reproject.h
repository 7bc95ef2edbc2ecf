// Reprojection from one picture to another by geometry alone, independent of any renderer.
#pragma once
#include "image/image.h"
#include "runtime/camera.h"

#include <cmath>
#include <limits>
#include <span>

struct FirstHit
{
    gpu::vec3 position; // metres, world; the ray's direction where nothing is hit
    gpu::vec3 normal;   // unit, of the triangle, to either side
    float footprint;    // metres: of a pixel's side at that distance, across the ray
    uint32_t slot;      // index into the package's BvhTriangles, gpu::kNone: nothing is hit

    bool isSky() const { return slot == gpu::kNone; }
};

/// What the rays through a picture's pixel centres meet.
struct FirstHits
{
    gpu::CameraParams camera;
    std::vector<FirstHit> hits; // [width * height]
};

/// The ray through the centre of a pixel, from the near plane to the far one, as shaders/primary/generate.comp makes
/// it.
gpu::Ray centerRay(const gpu::CameraParams& camera, uint32_t column, uint32_t row);

/// The rays through all centres, by rows; path is the pixel.
std::vector<gpu::Ray> centerRays(const gpu::CameraParams& camera);

/// @param hits of centerRays() in the same order, @param triangles the package's
FirstHits firstHits(const gpu::CameraParams& camera, std::span<const gpu::Hit> hits,
                    std::span<const gpu::BvhTriangle> triangles);

/// A place in a picture: pixels from its upper left corner, so that centres are at halves.
struct PicturePoint
{
    float x = std::numeric_limits<float>::quiet_NaN();
    float y = std::numeric_limits<float>::quiet_NaN();

    bool isSeen() const { return !std::isnan(x); }
};

/// Where the camera sees a hit of whichever camera, be something before it or not; not seen behind the eye and outside
/// of the picture.
PicturePoint project(const gpu::CameraParams& camera, const FirstHit& hit);

/// For each pixel of `now` where `then` showed the surface in its centre. Not seen, it was outside of that picture or
/// hidden: of the four pixels around the place more than half, by bilinear weight, show another surface. A pixel shows
/// the same surface where its hit is nearer to the plane of the triangle than a pixel is wide: a step lower than that
/// uncovers less than a pixel, however the camera moves. Both are of one size.
std::vector<PicturePoint> reproject(const FirstHits& now, const FirstHits& then);

/// `picture` as seen from where its surfaces are now: sampled at `places`, and `unseen` where there is none. By Catmull
/// and Rom's cubic: a bilinear one, half-way between pixels, would halve the variance of noise along each axis, and so
/// hide flicker, by how the camera happens to stand. All are of one size.
ImageF warp(const ImageF& picture, std::span<const PicturePoint> places, const ImageF& unseen);
