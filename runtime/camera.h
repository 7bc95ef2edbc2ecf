// A view of the scene and the rays it sends.
#pragma once
#include "format/package_read.h"
#include "shaders/primary/primary.h"

#include <optional>
#include <string>

struct Camera
{
    std::string name;
    gpu::vec3 position{};          // metres, world
    gpu::vec3 forward{0, 0, -1};   // unit
    gpu::vec3 up{0, 1, 0};         // unit, orthogonal to forward
    float vertical_fov = 0.8f;     // radians; 0: orthographic
    float orthographic_height = 0; // metres
    float near_plane = 0;          // metres along forward, before which nothing is seen
    float far_plane = 0;           // metres along forward, behind which nothing is seen; 0: there is none
};

std::vector<Camera> packageCameras(const package::Package& package);

/// The index of a camera that is named so, or has that index where no name matches.
std::optional<size_t> findCamera(const std::vector<Camera>& cameras, const std::string& name_or_index);

/// The sentence that findCamera() found none, with those that there are.
std::string noCamera(const std::vector<Camera>& cameras, const std::string& name_or_index);

/// The index of the camera named on the command line, or of the first where `name_or_index` is empty.
/// @return kUsage listing the cameras
Result<size_t> chooseCamera(const std::vector<Camera>& cameras, const std::string& name_or_index);

/// What shaders/primary/generate.comp needs of it for a picture of width x height pixels; sampling fields are left 0.
gpu::CameraParams cameraParams(const Camera& camera, uint32_t width, uint32_t height);

/// How far apart neighbouring pixels are: metres at distance 1, which are radians at the centre, or, orthographic, anywhere.
float pixelSide(const gpu::CameraParams& camera);

gpu::vec3 operator+(gpu::vec3 a, gpu::vec3 b);
gpu::vec3 operator*(float s, gpu::vec3 v);
float dot(gpu::vec3 a, gpu::vec3 b);
gpu::vec3 cross(gpu::vec3 a, gpu::vec3 b);
gpu::vec3 normalize(gpu::vec3 v);
