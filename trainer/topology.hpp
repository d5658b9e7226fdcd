// Triangles come and go: pruning, splitting, and where the first ones are.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "formats/dataset.hpp"
#include "trainer/config.hpp"
#include "trainer/model.hpp"

namespace tureen::trainer {

/// A changed set of faces. origin[t] is the face of the old model that face t came from; it is the
/// same triangle with the same texels, unless is_new[t].
struct Resampled {
  Model model;
  std::vector<std::uint32_t> origin;
  std::vector<std::uint8_t> is_new;
};

/// The `count` faces of most `pixels` (one number a face), in their old order; of equal ones the
/// first. With more than there are, all.
Resampled prune(const Model& model, std::span<const std::uint64_t> pixels, std::size_t count);

/// A split: the edge from corner `edge` to the next one, cut at `t` (0..1, from the first corner).
struct Split {
  std::uint32_t face;
  int edge;
  float t;
};

/// Replaces each named face by its two halves, which stand where the parent stood and at the end.
/// With `resample`, every texel of a child takes the field of the parent at its place (level by
/// level for the sum of all levels: least-squares free, exact where t = 1/2 and the level allows);
/// without, both children copy the parent's texels, as published. A face is named at most once.
Resampled split(const Model& model, std::span<const Split> splits, bool resample);

}  // namespace tureen::trainer
