// A scene of ours before all of it has arrived: the mesh that any glTF viewer sees, in the mean
// colours that our writer puts before network and texels (docs/format.md), for a page that shows a
// first picture while the rest is on its way.
//
// What it does not do: it knows no other files than our GLB, and of those not the slim ones, which
// have no mesh; it keeps nothing between two calls, so ask for the size until it is known, and for
// the scene once as many bytes are there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "scene/scene.hpp"

namespace tureen {

/// How many of the file's first bytes a preview takes, told by the first bytes that there are,
/// `prefix`: nothing until they hold the JSON chunk and the header behind it, some kilobytes in
/// most files; 0 where there will be no preview: another kind of file, a slim one, a soup without
/// faces. `name` stands for the file in errors. Throws InputError where the beginning of the file
/// is wrong already. Safe for untrusted bytes.
std::optional<std::uint64_t> tureen_glb_preview_size(std::span<const std::byte> prefix,
                                                     const std::string& name);

/// The scene as far as it can be shown: what read_tureen_glb will say of it (origin, cameras, info)
/// with its positions and triangles, but FaceColors, each face's final colour in the mean, or, of a
/// soup of vertex colours, VertexColors; rounded to 16 bits linear, opaque, cut-outs as whole
/// triangles, soft triangles as hard ones. Its quality is the default, and it has no defect().
/// Nothing where the size above is not known, 0, or more than `prefix` has. Throws InputError.
std::optional<Scene> read_tureen_glb_preview(std::span<const std::byte> prefix,
                                             const std::string& name);

}  // namespace tureen
