// The part of the extension that is independent of the appearance: version, scene info, positions
// and triangles. The full reader and the preview share it. Include it only in sources.
#pragma once

#include "formats/glb/glb_arrays.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// The root's TUREEN_triangle_soup. Throws InputError if it is missing or of an unsupported
/// version.
JsonView tureen_extension_of(const GlbArrays& arrays);

/// Whether the file has the layers of versions 4 and 5. Otherwise the extension itself is the only
/// layer.
bool has_layers(const JsonView& extension);

/// Name, source, notes, up, background and cameras.
void read_info(const JsonView& extension, Scene& scene);

/// The layer of a file without has_layers(), at its origin and without primitives.
Layer read_layer_at_origin(const JsonView& extension);

/// The layer of a node, in a file with has_layers(), without primitives.
Layer read_layer_of_node(const JsonView& node);

/// The material of a layer with the extension `extension`, if it has one.
std::optional<Material> read_layer_material(const GlbArrays& arrays, const JsonView& extension);

/// Locations of a soup's vertices and triangles in an uncompressed file. `extension` is that of the
/// root or of a layer.
struct GeometryLayout {
  std::uint64_t vertices = 0, faces = 0;
  GlbArrays::Location positions;
  GlbArrays::Location triangles;  // empty: face t is (3t, 3t + 1, 3t + 2)
};
GeometryLayout geometry_layout(const GlbArrays& arrays, const JsonView& extension);

/// Reads positions and triangles. Indices are not checked; defect() does that.
void read_geometry(GlbArrays& arrays, const GeometryLayout& layout, TriangleSoup& soup);

}  // namespace tureen
