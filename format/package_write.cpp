#include "format/package_write.h"
