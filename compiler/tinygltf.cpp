// The one translation unit that holds tinygltf. Images are read by images.cpp, Draco by gltf_draco.cpp: tinygltf's own
// Draco path trusts attribute ids and component counts of the file and drops decoding errors.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>
