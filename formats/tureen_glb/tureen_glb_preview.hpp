// A preview of a partially loaded file of ours. A page thus shows a first image while the rest
// loads.
// - A soup: the mesh for other glTF viewers with its mean colours. Our writer stores them before
//   network and texels (docs/format.md).
// - Splats that are stored as points: all of them in the colours of degree 0, which precede those
// of
//   higher degrees.
//
// Not supported: other formats, files with several layers, whose colours are not at the start, and
// compressed files, which have no mesh. No state is kept between calls: call for the size until it
// is known, and for the scene once as many bytes are available.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "formats/common/preview_size.hpp"
#include "scene/scene.hpp"

namespace tureen {

/// The size of a preview, from the available first bytes `prefix`. Returns nullopt until they
/// contain the JSON chunk and the next chunk's header, a few kilobytes in most files. There is no
/// preview for other formats, compressed files, several layers, soups without faces and layers
/// without splats. Errors print `name` as the file. Throws InputError if the available bytes are
/// invalid. Safe for untrusted bytes.
std::optional<PreviewSize> tureen_glb_preview_size(std::span<const std::byte> prefix,
                                                   const std::string& name);

/// The previewed scene: origin, cameras, info, positions and triangles as read_tureen_glb returns
/// them; splats, too, except harmonics of degree 1 and more. The appearance of a soup is
/// FaceColors, each face's mean final colour, or VertexColors for a soup of vertex colours. Colours
/// are rounded to 16 bits linear and opaque; cut-outs become whole triangles, soft triangles hard
/// ones. Its quality is the default, and it has no defect(). Returns nullopt if the size above is
/// unknown, 0, or larger than `prefix`. Throws InputError.
std::optional<Scene> read_tureen_glb_preview(std::span<const std::byte> prefix,
                                             const std::string& name);

}  // namespace tureen
