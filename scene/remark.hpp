// An assumption or loss while reading a file: a value that programs compare. describe() formats it
// as a sentence.
#pragma once

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

namespace tureen {

/// `kind` determines the number of counts, values and names; the comment after each kind lists
/// them.
struct Remark {
  enum class Kind {
    // Which way is up.
    up_unknown_to_format,      // names: the format. z is assumed
    up_unknown_to_trimesh,     // z is assumed
    up_unknown_to_checkpoint,  // -y is assumed
    up_unknown_to_splats,      // names: the format. -y is assumed
    up_of_colmap_scene,        // the checkpoint has flip_z: -y, and a black background
    up_of_synthetic_scene,     // no flip_z: +z, and a white background
    up_of_transforms,          // of a dataset: z, as in the scenes of NeRF
    up_of_cameras,             // of a dataset: the mean of its cameras' up axes
    up_of_no_camera,           // of a dataset whose cameras disagree: names[0]
    // Faces and vertices.
    polygons_split,          // counts: polygons
    small_faces_dropped,     // counts: faces with fewer than three corners
    corners_dropped,         // counts: corners. names: the primitive
    coordinates_rounded,     // from double to float
    soft_triangles_opaque,   // values: mean of mean_coverage(), mean opacity
    soft_triangles_dropped,  // counts: dropped, all. values: the smallest kept opacity
    // Splats.
    splats_dropped,            // counts: dropped, all
    splats_limited,            // counts: kept, all
    splat_colors_linear,       // in linear light, which SplatColor does not hold
    profile_assumed,           // names: the profile
    render_mode_unknown,       // names: the mode that the file asks for, the profile that is used
    octagon_q_assumed,         // values: Q
    splat_extensions_ignored,  // names: the types of the extensions
    // Colours.
    color_components_clamped,  // counts: components
    face_colors_dropped,       // the file has vertex colours as well
    colors_missing,
    face_colors_missing,   // counts: triangles
    face_colors_mapped,    // counts: faces with a colour map index
    vertex_colors_srgb,    // requested by the caller
    vertex_colors_linear,  // likewise
    vertex_colors_srgb_by_generator,
    vertex_colors_linear_by_gltf,
    colors_multiplied,  // as display-referred values
    materials_unlit,
    blending_cut_out,
    alpha_half_restored,  // counts: texels changed, all
    mean_colors_shown,    // names: the glTF extension, which is read only from .glb
    // Parts that are not drawn.
    animations_dropped,
    skins_dropped,
    morph_targets_dropped,
    points_and_lines_dropped,
    primitives_without_positions_dropped,
    other_projections_dropped,  // cameras
    blind_cameras_dropped,
    screen_interpolation_dropped,  // for the colours of soft triangles' corners
    shapes_missing,                // counts: indices of missing shapes; last: number of all
    shapes_untextured,             // counts: likewise
    preset_dropped,                // it selects among soft triangles
    preset_applied,                // from an earlier version, to the data. names: names_of(Edits)
    preset_keys_ignored,           // for settings that no longer exist. names: the keys
    // The files.
    text_ignored,        // counts: its first line
    bytes_ignored,       // counts: bytes after the last element
    content_misnamed,    // names: the extension, the format of the content
    settings_dropped,    // of a further scene in merged(). names: "cameras", "up axis", ..
    meta_missing,        // level 5, up -y and a black background are assumed
    level_missing,       // level 5 is assumed
    image_size_missing,  // counts: the assumed width and height
    lens_dropped,        // for cameras without photographs
    lens_undone,         // counts: largest number of cropped columns and rows
    fisheye_undone,      // values: largest horizontal angle of view that remains, in degrees
    points_missing,      // names: the file with a dataset's points
    pixels_masked,       // counts: photographs with ignored pixels, all
  };
  static constexpr std::size_t kinds = std::size_t(Kind::pixels_masked) + 1;

  Kind kind{};
  std::vector<std::uint64_t> counts = {};
  std::vector<double> values = {};
  std::vector<std::string> names = {};
  /// Name of the scene, if several scenes were merged.
  std::string scene = {};

  bool operator==(const Remark&) const = default;
  /// An arbitrary total order, for sets. Browser toolchains lack <=> for vectors.
  friend bool operator<(const Remark& a, const Remark& b) {
    return std::tie(a.kind, a.counts, a.values, a.names, a.scene) <
           std::tie(b.kind, b.counts, b.values, b.names, b.scene);
  }
};

/// The kind's name in JSON: "up_unknown_to_format".
const char* name_of(Remark::Kind kind);

/// A sentence in English.
std::string describe(const Remark& remark);

/// The option that changes the assumption, "--up changes it", or "".
std::string hint_of(const Remark& remark);

/// For each remark describe(), then "; " and the hint if there is one.
std::vector<std::string> described(const std::vector<Remark>& remarks);

}  // namespace tureen
