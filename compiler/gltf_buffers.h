// Loads the bytes of a glTF file's buffers, decompressed where buffer views are meshopt-compressed.
#pragma once
#include "compiler/gltf_document.h"
#include "compiler/input_files.h"
#include "compiler/warnings.h"

#include <filesystem>
#include <vector>

/// Reads every buffer that is needed and decodes compressed buffer views into buffers of their own, at the end of the
/// list. Buffers that only stand in for compressed views are read where a view cannot be decoded, and are else empty
/// but for a byte. Leaves in `document.json` plain buffers and views, the URI of each buffer being its index.
/// One that is missing or damaged is one byte long, with a warning, so that what lies in it cannot be read.
/// @return one element a buffer, exactly its byteLength; kUnsupported where one is of a kind that is not read, or
///         where a view can neither be decoded nor is there uncompressed
Result<std::vector<std::vector<unsigned char>>> loadBuffers(GltfDocument& document, InputFiles& files,
                                                            Warnings& warnings);
