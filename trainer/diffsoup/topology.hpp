// Triangles come and go: pruning and splitting. Which edges are split:
// trainer/diffsoup/split_choice.hpp; where the first triangles are:
// trainer/diffsoup/initialise.hpp.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trainer/diffsoup/model.hpp"

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

/// The faces that have any pixels, in their old order.
Resampled prune_unseen(const Model& model, std::span<const std::uint64_t> pixels);

/// All faces along a curve that fills space (Morton 1966): faces that are neighbours there are
/// mostly neighbours in every image, and what one has read the next finds in the cache.
Resampled in_space_order(const Model& model);

/// A split: the edge from corner `edge` to the next one, cut at `t` (0..1, from the first corner).
struct Split {
  std::uint32_t face;
  int edge;  // 0..2
  float t;
};

enum class ChildTexture {
  resampled,  // the image stays: a child shows what its parent showed there
  copied,     // both children copy the parent's texels: as published, the image pops
};

/// Cuts faces in two, one after the other. The half with the edge's first corner stands where the
/// parent stood, the other at the end, so a later split may name either: face F + i is the second
/// half of split i, where F is the old number of faces. Orientation is kept.
///
/// Resampled, every texel of max_level takes the value (after the sigmoid, as it is drawn) that the
/// face of the old model shows at its place, however often that was cut; between texels both are
/// piecewise linear, on other cells. At t = 1/2 every second texel lies on one of the old.
Resampled split(const Model& model, std::span<const Split> splits, ChildTexture texture);

/// What a split does to the corners, three a face: the first half in its place, the second at the
/// end. Both take the very same point.
void cut_face(std::vector<glm::vec3>& positions, const Split& split);

}  // namespace tureen::trainer
