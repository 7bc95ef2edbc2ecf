// The fixed parts of a .lumi file: header and chunk table. FORMAT.md is the prose of this header.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace package
{
inline constexpr std::array<uint8_t, 12> kMagic{0xAB, 'L', 'U', 'M', 'I', ' ', '1', 0xBB, '\r', '\n', 0x1A, '\n'};
inline constexpr uint16_t kVersionMajor = 3;     // readers refuse another
inline constexpr uint16_t kVersionMinor = 2;     // readers ignore a higher one
inline constexpr uint32_t kBulkAlignment = 4096; // of uncompressed bulk chunks: mapped pages go to the GPU as they lie
inline constexpr uint32_t kSmallAlignment = 16;  // of META and compressed chunks
inline constexpr uint64_t kMaxExpansion = 1024;  // raw_bytes <= this x stored_bytes: bounds what a reader allocates
inline constexpr uint64_t kMaxMetaBytes = 64u << 20;
inline constexpr uint64_t kMaxMotionBytes = 512u << 20;
inline constexpr uint32_t kMaxMotionTables = 1u << 22; // nodes, bones, channels, objects: bounds what a reader verifies
inline constexpr uint32_t kMaxChunkCount = 64;

struct Header // at byte 0, little-endian
{
    std::array<uint8_t, 12> magic;
    uint16_t version_major;
    uint16_t version_minor;
    uint64_t file_bytes;
    uint64_t chunk_table_offset; // of ChunkEntry[chunk_count]
    uint32_t chunk_count;
    uint32_t reserved;         // 0
    uint64_t chunk_table_hash; // XXH3-64 of the chunk table
    uint64_t header_hash;      // XXH3-64 of the bytes before this field
};
static_assert(sizeof(Header) == 56);

enum class Codec : uint32_t
{
    kNone = 0,
    kZstd = 1
};

/// Chunk identifiers: four ASCII characters, first character in the lowest byte.
constexpr uint32_t fourcc(const char (&s)[5])
{
    return uint32_t(uint8_t(s[0])) | uint32_t(uint8_t(s[1])) << 8 | uint32_t(uint8_t(s[2])) << 16 |
           uint32_t(uint8_t(s[3])) << 24;
}
inline constexpr uint32_t kMetaChunk = fourcc("META");              // FlatBuffer lumicut.fb.Meta
inline constexpr uint32_t kBvhNodesChunk = fourcc("NODE");          // StoredNode[]
inline constexpr uint32_t kLeafTrianglesChunk = fourcc("LEAF");     // uint32_t[]: triangles of the leaves
inline constexpr uint32_t kTrianglesChunk = fourcc("TRIS");         // StoredTriangle[]
inline constexpr uint32_t kPositionsChunk = fourcc("VPOS");         // gpu::vec3[], by vertex
inline constexpr uint32_t kVertexAttributesChunk = fourcc("VATT");  // StoredVertex[]
inline constexpr uint32_t kVertexExtrasChunk = fourcc("VEXT");      // VertexExtras[], may be absent
inline constexpr uint32_t kMaterialsChunk = fourcc("MATL");         // gpu::Material[]
inline constexpr uint32_t kTextureRefsChunk = fourcc("TREF");       // gpu::TextureRef[], may be absent
inline constexpr uint32_t kTexturePageChunk = fourcc("TEXP");       // one per Meta.texture_pages entry, by index
inline constexpr uint32_t kLightsChunk = fourcc("LITE");            // gpu::Light[], may be absent (no light)
inline constexpr uint32_t kLightAliasesChunk = fourcc("LALS");      // gpu::AliasEntry[light count]
inline constexpr uint32_t kEnvironmentChunk = fourcc("ENVR");       // float[4][width * height]
inline constexpr uint32_t kEnvironmentTexelsChunk = fourcc("EIMP"); // gpu::EnvironmentTexel[importance w * h]
inline constexpr uint32_t kCausticTargetsChunk = fourcc("CTGT");    // gpu::CausticTarget[], may be absent
// Since version 3.1; a package has them where something moves, the yields where some are not 1. Without them it shows the
// same at rest.
inline constexpr uint32_t kMotionChunk = fourcc("MOTN");         // FlatBuffer lumicut.fb.Motion
inline constexpr uint32_t kMovingVerticesChunk = fourcc("MVTX"); // gpu::MovingVertex[], of the last vertices of VPOS
inline constexpr uint32_t kInfluencesChunk = fourcc("MINF");     // gpu::Influence[]
inline constexpr uint32_t kLightYieldsChunk = fourcc("LYLD");    // gpu::vec3[light count], may be absent
inline constexpr uint32_t kMorphOffsetsChunk = fourcc("MMRF");   // gpu::MorphOffset[], may be absent

/// Whether a reader that does not know a chunk must refuse the file.
constexpr bool isRequired(uint32_t id)
{
    return id != kMotionChunk && id != kMovingVerticesChunk && id != kInfluencesChunk && id != kMorphOffsetsChunk &&
           id != kLightYieldsChunk;
}

struct ChunkEntry
{
    uint32_t id;       // fourcc
    uint32_t index;    // several chunks of one id are told apart by it
    uint32_t required; // 1: a reader that does not know `id` must refuse the file; 0: it may skip the chunk
    Codec codec;
    uint32_t alignment; // of `offset`, a power of two
    uint32_t reserved;  // 0
    uint64_t offset;    // from the start of the file
    uint64_t stored_bytes;
    uint64_t raw_bytes; // after decompression; equal to stored_bytes without a codec
    uint64_t hash;      // XXH3-64 of the stored bytes
};
static_assert(sizeof(ChunkEntry) == 56);

/// "TEXP" for 0x50584554; characters outside printable ASCII become '?'.
std::string chunkName(uint32_t id);
} // namespace package
