// tinygltf's implementation, for the JSON alone: no files, no images, no writing (formats/
// gltf_document.hpp says why).
#include "formats/gltf/tinygltf.hpp"

#include <fstream>  // its writer wants it, which we never call

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
