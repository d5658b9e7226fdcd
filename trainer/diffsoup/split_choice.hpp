// Which edges are split: the two rules of DiffSoup (arXiv 2603.27151, supplement). Both return
// splits in order, longest first, of faces and of their children, for `split` to carry out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "trainer/diffsoup/topology.hpp"

namespace tureen::trainer {

/// Bisects the longest edge in the world, again and again, until there are `budget` faces: as
/// published for random initialisation. Of equal edges the one of the lower face. Exact unless
/// there is no face at all.
std::vector<Split> longest_edges(const Model& model, std::size_t budget);

/// Bisects the face of the greatest error, again and again, at its longest edge, until there are
/// `budget` faces; each child has half of its parent's error. `errors` has one number a face; faces
/// without error come after all others, the longest edge first.
/// Triangles go where the image needs them, which a length alone does not tell.
std::vector<Split> greatest_errors(const Model& model, std::span<const float> errors,
                                   std::size_t budget);

/// One view that chooses edges.
struct SplitView {
  Camera camera;
  /// One a face, not 0 where the face is the nearest in some pixel of this view.
  std::span<const std::uint8_t> visible;
};

struct ProjectedSplits {
  double fraction = 0.2;   // of the image's height: longer edges are split
  std::size_t budget = 0;  // never more faces than this
  double near = 0.01;      // what is nearer to the camera's plane is not in the image
};

/// View by view, splits the longest projected edge of the faces that are visible in it, and of
/// their children, as long as it is longer than the threshold; where the projected edge is halved.
///
/// Published code leaves out every edge with an end outside the image, and so never splits the
/// largest faces. Here an edge counts by the part of it that is in the image and before the near
/// plane, and is cut in the middle of that part.
std::vector<Split> longest_projected_edges(const Model& model, std::span<const SplitView> views,
                                           const ProjectedSplits& rule);

}  // namespace tureen::trainer
