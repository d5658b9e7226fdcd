// The choice of edges to split: two rules from DiffSoup (arXiv 2603.27151, supplement),
// longest_edges and longest_projected_edges, and our greatest_errors. Each returns the splits of
// faces and their children in the order for `split`. Faces before `first` are not split.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "trainer/diffsoup/topology.hpp"

namespace tureen::trainer {

/// Bisects the longest edge in world units until there are `budget` faces, as published for random
/// initialisation. Ties go to the lower face. The final number is exact unless the model has no
/// faces.
std::vector<Split> longest_edges(const Model& model, std::size_t budget, std::size_t first = 0);

/// Bisects the face with the greatest error at its longest edge until there are `budget` faces.
/// Each child has half its parent's error. `errors`: one number per face. Faces without error come
/// after all others, the longest edge first.
std::vector<Split> greatest_errors(const Model& model, std::span<const float> errors,
                                   std::size_t budget, std::size_t first = 0);

/// One view that chooses edges.
struct SplitView {
  Camera camera;
  /// One per face, not 0 if the face is the nearest in a pixel of this view.
  std::span<const std::uint8_t> visible;
};

struct ProjectedSplits {
  double fraction = 0.2;   // of the image's height: longer edges are split
  std::size_t budget = 0;  // maximum number of faces
  std::size_t first = 0;   // faces before it are not split
  double near = 0.01;      // near plane: distance from the camera's plane, world units
};

/// In each view, splits the longest projected edge of the visible faces and their children while it
/// is longer than the threshold. The cut halves the projected edge.
///
/// The published code skips every edge with an end outside the image, and so never splits the
/// largest faces. Here, only the part of an edge in the image and beyond the near plane counts; the
/// cut is in the middle of that part.
std::vector<Split> longest_projected_edges(const Model& model, std::span<const SplitView> views,
                                           const ProjectedSplits& rule);

}  // namespace tureen::trainer
