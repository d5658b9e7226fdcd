// The number of primitives of a model in training.
#pragma once

#include <cstddef>

namespace tureen::trainer {

enum class PrimitiveKind { triangles, splats };

/// "triangles" or "splats".
constexpr const char* name_of(PrimitiveKind kind) {
  return kind == PrimitiveKind::triangles ? "triangles" : "splats";
}

/// "triangle" or "splat", for counted().
constexpr const char* noun_of(PrimitiveKind kind) {
  return kind == PrimitiveKind::triangles ? "triangle" : "splat";
}

struct PrimitiveCount {
  PrimitiveKind kind;
  std::size_t count;
};

}  // namespace tureen::trainer
