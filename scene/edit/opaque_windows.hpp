// Triangle windows (Triangle Splatting, arXiv 2505.19175) as opaque triangles.
#pragma once

#include <vector>

#include "scene/remark.hpp"
#include "scene/splats.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

/// The triangles of windows with their harmonics, of faces or of vertices.
TriangleSoup hard_shapes(std::vector<glm::vec3> corners, SplatColor color);

struct OpaqueResult {
  TriangleSoup soup;
  std::vector<Remark> remarks;  // what was lost
};

/// The hard_shapes(), opaque. Keeps every triangle with an
/// opacity of at least `minimum_opacity`. Triangle Splatting itself skips triangles below 0.01. The
/// kernel of `splats` is TriangleWindows.
OpaqueResult to_opaque(Splats splats, float minimum_opacity = 0.01f);

}  // namespace tureen
