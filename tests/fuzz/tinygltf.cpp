// Debian ships tinygltf compiled, without coverage and sanitizers; the fuzz targets compile its header themselves.
#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
