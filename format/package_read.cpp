#include "format/package_read.h"
