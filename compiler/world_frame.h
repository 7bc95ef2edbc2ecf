// The coordinates that a package is written in: moved and scaled so that single precision is enough for them.
#pragma once
#include "compiler/import_gltf.h"

/// Chooses the origin and the unit of length by where the scene is seen from (its cameras' median, or the median of its
/// triangles without any) and how far the median triangle is from there, its size.
/// The origin is 0 unless that centre is more than 64 sizes from it, and then that of an object near the centre; the
/// unit is 1 m for sizes of 2^-10 m to 2^20 m. Within both limits nothing moves. Depends on nothing but its argument.
WorldFrame chooseFrame(const ImportedScene& imported);

/// Moves instances, cameras, lights and media of `imported` from the file's coordinates to those of `frame` and records
/// it in the scene; a unit other than 1 m adds a warning. What is seen does not change.
/// @return kInvalid where a camera or a light has no place among single-precision numbers there
Status moveIntoFrame(ImportedScene& imported, const WorldFrame& frame);
