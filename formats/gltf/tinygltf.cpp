// The implementation of tinygltf, for JSON only: no files, no images, no writing.
// formats/gltf/gltf_document.hpp has the reason.
#include "formats/gltf/tinygltf.hpp"

#include <fstream>  // for tinygltf's writer, which is not used

#define TINYGLTF_IMPLEMENTATION
#include <tiny_gltf.h>
