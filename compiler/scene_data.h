// The scene between reading glTF and writing the package.
#pragma once
#include "compiler/warnings.h"
#include "format/gpu_motion.h"
#include "format/gpu_scene.h"
#include "format/motion_generated.h"
#include "format/vec3d.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// Decoded texels, RGBA8, row 0 on top, as the file stores them (colour textures stay sRGB-encoded).
struct TextureImage
{
    std::string name; // for messages
    uint32_t width = 0;
    uint32_t height = 0;
    bool srgb = false;            // base colour, emissive, specular colour
    std::vector<uint8_t> texels;  // [4 * width * height]
    std::vector<uint16_t> deep{}; // the same in 16 bits where the file has more than 8, else empty
    bool linear_light = false;    // colours are linear light, whatever `srgb` says; until decodeImages() returns
};

/// One use of a texture by a material; becomes a gpu::TextureRef once images have found their page and layer.
struct TextureUse
{
    uint32_t image = 0;    // index into SceneData::images
    uint32_t sampling = 0; // gpu::kWrap*, kSampleNearest, kSampleUv1 as in gpu::TextureRef::sampling
    gpu::vec3 u_row{1, 0, 0};
    gpu::vec3 v_row{0, 1, 0};
};

/// Where the package's coordinates lie in the file's: position in the file = origin + unit * position in the package.
/// What this compiler calls world space is the package's from moveIntoFrame() on and the file's before.
struct WorldFrame
{
    Vec3d origin{};  // metres, in the file's coordinates
    double unit = 1; // metres per unit of the package, a power of two
};

/// All triangles of the scene in world space.
struct WorldMesh
{
    std::vector<gpu::vec3> positions;              // [vertex_count]
    std::vector<gpu::VertexAttributes> attributes; // [vertex_count]
    std::vector<gpu::uvec3> triangles;             // [triangle_count] vertex indices
    std::vector<uint32_t> materials;               // [triangle_count] index into SceneData::materials
    std::vector<uint32_t> objects;                 // [triangle_count] which mesh node it came from, 0..object_count-1
    uint32_t object_count = 0;
    std::vector<uint32_t>
        moving; // first triangle of each object that moves; they come last and end where the next begins

    size_t staticTriangleCount() const { return moving.empty() ? triangles.size() : moving.front(); }
};

/// What moves the last vertices of the mesh, and lights and cameras.
struct MotionData
{
    lumicut::fb::MotionT tables; // lights and cameras by their number in SceneData until the package is made
    std::vector<gpu::MovingVertex> vertices; // the last ones of the mesh
    std::vector<gpu::Influence> influences;
    std::vector<gpu::MorphOffset> morph_offsets;
};

struct PunctualLight
{
    uint32_t kind = gpu::kLightPoint; // point, spot, directional
    Vec3d position{};                 // world
    gpu::vec3 direction{0, 0, -1};    // unit, the way the light travels
    gpu::vec3 intensity{};            // W/sr (point, spot; per squared unit of length) or W/m^2 (directional), coloured
    float inner_cone = 0;             // radians, spot
    float outer_cone = 0.785398163f;
    bool moves = false; // it is kept where it has no power at rest
};

/// Equirectangular radiance, mapping as in gpu_scene.h.
struct EnvironmentImage
{
    uint32_t width = 0;
    uint32_t height = 0;
    std::vector<gpu::vec4> texels; // [width * height] W/(m^2 sr), row 0 at +Y, w unused (1)
    float rotation = 0;            // radians about +Y by which the map is turned, -pi to pi
};

struct CameraView
{
    std::string name;
    Vec3d position{};
    gpu::vec3 forward{0, 0, -1};   // unit
    gpu::vec3 up{0, 1, 0};         // unit, orthogonal to forward
    float vertical_fov = 0;        // radians; 0: orthographic
    float orthographic_height = 0; // 0: perspective
    float near_plane = 0;          // distance along forward before which nothing is seen
    float far_plane = 0;           // distance along forward behind which nothing is seen; 0: there is none
};

/// Counts of what import and clean-up did, for the report and for Meta.statistics.
struct ImportCounts
{
    uint64_t degenerate_triangles = 0;
    uint64_t duplicate_triangles = 0;
    uint64_t generated_normals = 0;  // vertices
    uint64_t generated_tangents = 0; // vertices
    uint64_t dropped_primitives = 0; // points and lines
};

struct SceneData
{
    std::string generator;
    std::string copyright;
    WorldFrame frame;
    Warnings warnings;
    WorldMesh mesh;
    std::vector<gpu::Material> materials; // *_texture members index texture_uses
    std::vector<std::string> material_names;
    std::vector<TextureUse> texture_uses;
    std::vector<TextureImage> images;
    std::vector<PunctualLight> lights;
    std::optional<EnvironmentImage> environment;
    std::vector<CameraView> cameras;
    std::shared_ptr<MotionData> motion; // null: nothing moves
    ImportCounts counts;
};
