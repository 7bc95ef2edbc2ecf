// The one translation unit of this program that holds stb's PNG reader.
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb_image.h>
