#include "format/package_layout.h"
