// Pruning and splitting of triangles. trainer/diffsoup/split_choice.hpp chooses the edges to split;
// trainer/diffsoup/initialise.hpp places the first triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trainer/diffsoup/model.hpp"

namespace tureen::trainer {

/// A changed set of faces. origin[t] is the old face of the new face t. Both have the same corners
/// and texels, unless is_new[t].
struct Resampled {
  Model model;
  std::vector<std::uint32_t> origin;
  std::vector<std::uint8_t> is_new;
};

/// The `count` faces with the most `pixels` (one number per face), at most all, in their old order.
/// Ties go to the lower index.
Resampled prune(const Model& model, std::span<const std::uint64_t> pixels, std::size_t count);

/// The faces with at least one pixel, in their old order.
Resampled prune_unseen(const Model& model, std::span<const std::uint64_t> pixels);

/// All faces in the order of a space-filling curve (Morton 1966). Neighbours on the curve are
/// mostly neighbours in every image, so they share data in the cache. Faces before `first` stay in
/// place.
Resampled in_space_order(const Model& model, std::size_t first = 0);

/// A split: the edge from corner `edge` to the next one, cut at `t` (0..1, from the first corner).
struct Split {
  std::uint32_t face;
  int edge;  // 0..2
  float t;
};

enum class ChildTexture {
  resampled,  // a child has its parent's values at the same points: the image stays the same
  copied,     // both children copy the parent's texels (published): the image jumps
};

/// Cuts faces in two, one after the other. The half with the edge's first corner takes the parent's
/// index, the other half goes to the end. Later splits may use either: face F + i is the second
/// half of split i, where F is the old number of faces. Orientation does not change.
///
/// With ChildTexture::resampled, every texel of max_level takes the old face's value (after the
/// sigmoid, as drawn) at its position, after any number of cuts. Between texels both textures are
/// piecewise linear, but on different cells. At t = 1/2 every second texel coincides with an old
/// one.
Resampled split(const Model& model, std::span<const Split> splits, ChildTexture texture);

/// Applies a split to the corners, three per face: the first half in its place, the second at the
/// end. Both halves have exactly the same new corner.
void cut_face(std::vector<glm::vec3>& positions, const Split& split);

}  // namespace tureen::trainer
