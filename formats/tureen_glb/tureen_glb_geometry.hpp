// What the extension says before any appearance: its version, what is known of the scene, positions
// and triangles. The reader of whole files and the preview share it. Include it in sources only.
#pragma once

#include "formats/gltf/glb_arrays.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// The root's TUREEN_triangle_soup. Throws InputError where there is none, or one of a version that
/// is not read.
JsonView tureen_extension_of(const GlbArrays& arrays);

/// Name, source, notes, up, background, origin and cameras.
void read_info(const JsonView& extension, Scene& scene);

/// Where the soup's own vertices and triangles lie in a file that is not slim.
struct GeometryLayout {
  std::uint64_t vertices = 0, faces = 0;
  GlbArrays::Location positions;
  GlbArrays::Location triangles;  // of no bytes: face t is (3t, 3t + 1, 3t + 2)
};
GeometryLayout geometry_layout(const GlbArrays& arrays, const JsonView& extension);

/// Positions and triangles; that the triangles name vertices that exist, defect() must say.
void read_geometry(GlbArrays& arrays, const GeometryLayout& layout, TriangleSoup& soup);

}  // namespace tureen
