// Follows every index of a package as shaders do, to show that none leads outside.
#pragma once
#include "format/package_read.h"

/// Aborts on an index out of range or a traversal that overflows its stack; under a sanitizer, also on a stray read.
/// @return a sum over everything read, so that no read can be left out
double walkPackage(const package::Package& package);
