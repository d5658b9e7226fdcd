// A reader's assumption or loss: a value that programs compare, and the sentence for people that
// describe() makes of it.
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

namespace tureen {

/// `kind` decides how many counts, values and names there are; it lists them after its name.
struct Remark {
  enum class Kind {
    // Which way is up.
    up_unknown_to_format,      // names: the format. z is assumed
    up_unknown_to_trimesh,     // z is assumed
    up_unknown_to_checkpoint,  // -y is assumed
    up_of_colmap_scene,        // the checkpoint has a flip_z: -y, and a black background
    up_of_synthetic_scene,     // it has none: +z, and a white background
    up_of_transforms,          // a dataset's: z, as in the scenes of NeRF
    up_of_cameras,             // a dataset's: the mean of its cameras
    up_of_no_camera,           // a dataset's cameras disagree: -y
    // Faces and vertices.
    polygons_split,          // counts: polygons
    small_faces_dropped,     // counts: faces of fewer than three corners
    corners_dropped,         // counts: corners. names: the primitive
    coordinates_rounded,     // from double to float
    soft_triangles_opaque,   // values: mean solidity, mean opacity
    soft_triangles_dropped,  // counts: dropped, all. values: the least opacity kept
    // Colours.
    color_components_clamped,  // counts: components
    face_colors_dropped,       // the file colours vertices, too
    colors_missing,
    face_colors_missing,   // counts: triangles
    face_colors_mapped,    // counts: faces with a number of a colour map
    vertex_colors_srgb,    // asked for by the caller
    vertex_colors_linear,  // likewise
    vertex_colors_srgb_by_generator,
    vertex_colors_linear_by_gltf,
    colors_multiplied,  // as display-referred values
    materials_unlit,
    blending_cut_out,
    alpha_half_restored,  // counts: texels changed, all
    mean_colors_shown,    // names: the extension that is read from .glb alone
    // Parts that are not drawn.
    animations_dropped,
    skins_dropped,
    morph_targets_dropped,
    points_and_lines_dropped,
    primitives_without_positions_dropped,
    other_projections_dropped,  // cameras
    blind_cameras_dropped,
    window_parameters_dropped,     // vertex weights and sigma of a checkpoint
    screen_interpolation_dropped,  // of a checkpoint's colours
    shapes_missing,                // counts: the shapes missing; the last: all
    shapes_untextured,             // counts: likewise
    preset_dropped,                // it chooses among soft triangles
    preset_applied,                // of an earlier version, to the data. names: names_of(Edits)
    preset_keys_ignored,           // of settings that no longer exist. names: the keys
    // The files.
    text_ignored,        // counts: the line it begins at
    bytes_ignored,       // counts: bytes after the last element
    content_misnamed,    // names: the extension, the format of the content
    meta_missing,        // level 5, up -y and a black background are assumed
    level_missing,       // level 5 is assumed
    image_size_missing,  // counts: the width and height assumed
    lens_dropped,        // of cameras without photographs
    lens_undone,         // counts: columns and rows cut off, at most
  };
  static constexpr std::size_t kinds = std::size_t(Kind::lens_undone) + 1;

  Kind kind{};
  std::vector<std::uint64_t> counts = {};
  std::vector<double> values = {};
  std::vector<std::string> names = {};

  bool operator==(const Remark&) const = default;
  /// Any order, for sets. Browser toolchains lack <=> of vectors.
  friend bool operator<(const Remark& a, const Remark& b) {
    return std::tie(a.kind, a.counts, a.values, a.names) <
           std::tie(b.kind, b.counts, b.values, b.names);
  }
};

/// The kind as JSON spells it: "up_unknown_to_format".
const char* name_of(Remark::Kind kind);

/// A sentence for people.
std::string describe(const Remark& remark);

/// The option of the program that reads otherwise, "--up changes it", or "".
std::string hint_of(const Remark& remark);

/// describe(), and after "; " the hint where there is one.
std::vector<std::string> described(const std::vector<Remark>& remarks);

}  // namespace tureen
