#include "scene/remark.hpp"

#include <array>
#include <cmath>

#include "base/decimal_text.hpp"

namespace tureen {

namespace {

using Kind = Remark::Kind;

/// In the order of the enumerators.
constexpr std::array<const char*, Remark::kinds> kind_names{
    "up_unknown_to_format",
    "up_unknown_to_trimesh",
    "up_unknown_to_checkpoint",
    "up_unknown_to_splats",
    "up_of_colmap_scene",
    "up_of_synthetic_scene",
    "up_of_transforms",
    "up_of_cameras",
    "up_of_no_camera",
    "polygons_split",
    "small_faces_dropped",
    "corners_dropped",
    "coordinates_rounded",
    "soft_triangles_opaque",
    "soft_triangles_dropped",
    "splats_dropped",
    "splats_limited",
    "splat_colors_linear",
    "profile_assumed",
    "render_mode_unknown",
    "octagon_q_assumed",
    "splat_extensions_ignored",
    "color_components_clamped",
    "face_colors_dropped",
    "colors_missing",
    "face_colors_missing",
    "face_colors_mapped",
    "vertex_colors_srgb",
    "vertex_colors_linear",
    "vertex_colors_srgb_by_generator",
    "vertex_colors_linear_by_gltf",
    "colors_multiplied",
    "materials_unlit",
    "blending_cut_out",
    "alpha_half_restored",
    "mean_colors_shown",
    "animations_dropped",
    "skins_dropped",
    "morph_targets_dropped",
    "points_and_lines_dropped",
    "primitives_without_positions_dropped",
    "other_projections_dropped",
    "blind_cameras_dropped",
    "screen_interpolation_dropped",
    "shapes_missing",
    "shapes_untextured",
    "preset_dropped",
    "preset_applied",
    "preset_keys_ignored",
    "text_ignored",
    "bytes_ignored",
    "content_misnamed",
    "settings_dropped",
    "meta_missing",
    "level_missing",
    "image_size_missing",
    "lens_dropped",
    "lens_undone",
    "fisheye_undone",
    "points_missing",
    "pixels_masked",
};

std::string counted(std::uint64_t count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// "shape 1 of 8 ", "shapes 1, 2 and 5 of 8 ".
std::string shapes(const std::vector<std::uint64_t>& counts) {
  const std::size_t listed = counts.size() - 1;
  std::string text = listed == 1 ? "shape " : "shapes ";
  for (std::size_t i = 0; i < listed; ++i)
    text += (i == 0 ? "" : i + 1 < listed ? ", " : " and ") + std::to_string(counts[i]);
  return text + " of " + std::to_string(counts.back()) + " ";
}

/// "site, color".
std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// The sentence, without the scene's name.
std::string sentence_of(const Remark& remark) {
  const auto& [kind, counts, values, names, scene] = remark;
  switch (kind) {
    case Kind::up_unknown_to_format:
      return names[0] + " stores no up axis: z is assumed";
    case Kind::up_unknown_to_trimesh:
      return "trimesh, which wrote the file, stores no up axis: z is assumed";
    case Kind::up_unknown_to_checkpoint:
      return "the checkpoint stores no up axis: -y is assumed, as in COLMAP; scenes trained on "
             "Blender images have +z";
    case Kind::up_unknown_to_splats:
      return names[0] +
             " stores no up axis: -y is assumed, as in COLMAP; scenes trained on Blender "
             "images have +z";
    case Kind::up_of_colmap_scene:
      return "the checkpoint has flip_z: a COLMAP scene is assumed, with up -y and a black "
             "background";
    case Kind::up_of_synthetic_scene:
      return "the checkpoint has no flip_z: a synthetic scene is assumed, with up +z and a white "
             "background";
    case Kind::up_of_transforms:
      return "The up axis is assumed to be z, as in the scenes of NeRF and instant-ngp.";
    case Kind::up_of_cameras:
      return "The up axis is assumed to be the mean of the cameras' up axes.";
    case Kind::up_of_no_camera:
      return "The cameras' up axes disagree; " + names[0] + " is assumed.";
    case Kind::polygons_split:
      return counted(counts[0], "polygon", "polygons") +
             " with more than three corners split into triangles.";
    case Kind::small_faces_dropped:
      return counted(counts[0], "face", "faces") + " with fewer than three corners skipped.";
    case Kind::corners_dropped:
      return names[0] + ": " + std::to_string(counts[0]) +
             " corners are not a multiple of three; the incomplete triangle is skipped";
    case Kind::coordinates_rounded:
      return "Coordinates of type double were rounded to float.";
    case Kind::soft_triangles_opaque:
      return "soft triangles are drawn opaque: on average, a soft triangle covers " +
             fixed_decimal(100 * values[0], 0) + "% of its area (opacity " +
             fixed_decimal(values[1], 2) + "), the opaque face covers all of it";
    case Kind::soft_triangles_dropped:
      return std::to_string(counts[0]) + " of " + std::to_string(counts[1]) +
             " soft triangles have an opacity below " + short_decimal(values[0], 6) + ": dropped";
    case Kind::splats_dropped:
      return std::to_string(counts[0]) + " of " + std::to_string(counts[1]) + " splats " +
             (counts[0] == 1 ? "has" : "have") +
             " a value that is not finite or outside its range: dropped";
    case Kind::splats_limited:
      return std::to_string(counts[0]) + " of " + std::to_string(counts[1]) +
             " splats were read: those with the largest opacity times area";
    case Kind::splat_colors_linear:
      return "the splats were trained and are blended in linear light; they are drawn as if their "
             "colours were display-referred, and look different";
    case Kind::profile_assumed:
      return "the file does not store how its splats are rendered: the profile " + names[0] +
             " is assumed";
    case Kind::render_mode_unknown:
      return "the render mode '" + names[0] + "' of the file is unknown: the profile " + names[1] +
             " is used";
    case Kind::octagon_q_assumed:
      return "the file does not store the radius of its octagons, sqrt(Q) standard deviations: Q "
             "= " +
             short_decimal(values[0], 6) + " is assumed";
    case Kind::splat_extensions_ignored:
      return "extensions of the file that are not supported are ignored: " + listed(names);
    case Kind::color_components_clamped:
      return counted(counts[0], "colour component", "colour components") + " outside 0..1 clamped.";
    case Kind::face_colors_dropped:
      return "The file has vertex and face colours; the face colours are ignored.";
    case Kind::colors_missing:
      return "The file has no colours; everything is drawn grey (0.8).";
    case Kind::face_colors_missing:
      return counted(counts[0], "triangle has no colour and is",
                     "triangles have no colour and are") +
             " drawn grey (0.8).";
    case Kind::face_colors_mapped:
      return "The colours of " + counted(counts[0], "face", "faces") +
             " are indices of a colour map, which OFF does not store.";
    case Kind::vertex_colors_srgb:
      return "vertex colours are read as sRGB, as requested";
    case Kind::vertex_colors_linear:
      return "vertex colours are read as linear, as requested";
    case Kind::vertex_colors_srgb_by_generator:
      return "vertex colours are read as sRGB, because the file's generator stores them so";
    case Kind::vertex_colors_linear_by_gltf:
      return "vertex colours are read as linear, as glTF specifies";
    case Kind::colors_multiplied:
      return "texture, factor and vertex colour are multiplied as display-referred values; this "
             "approximates the product in linear light that glTF specifies";
    case Kind::materials_unlit:
      return "lit materials are drawn unlit, by their base colour";
    case Kind::blending_cut_out:
      return "blended materials are drawn as cut-outs at an alpha of 0.5";
    case Kind::alpha_half_restored:
      return std::to_string(counts[0]) + " of " + std::to_string(counts[1]) +
             " texels have an alpha byte of 127, and hardly any have 126 or 128: 127 is assumed to "
             "be a truncated 1/2 and becomes 128, so that they are drawn as in training";
    case Kind::mean_colors_shown:
      return names[0] + " is read only from .glb: mean colours are drawn";
    case Kind::animations_dropped:
      return "animations are not played";
    case Kind::skins_dropped:
      return "skinned meshes are drawn in their bind pose";
    case Kind::morph_targets_dropped:
      return "morph targets are not applied";
    case Kind::points_and_lines_dropped:
      return "points and lines are not drawn";
    case Kind::primitives_without_positions_dropped:
      return "primitives without POSITION are not drawn";
    case Kind::other_projections_dropped:
      return "cameras that are not perspective are skipped";
    case Kind::blind_cameras_dropped:
      return "cameras that see nothing are skipped";
    case Kind::screen_interpolation_dropped:
      return "colours are interpolated in perspective, but in screen space by the original "
             "renderer: large triangles near the camera differ";
    case Kind::shapes_missing:
      return shapes(counts) + "missing: the others are drawn";
    case Kind::shapes_untextured:
      return shapes(counts) + "without feature images: the others are drawn";
    case Kind::preset_dropped:
      return "the preset selects soft triangles, but some of them are not drawn: the preset is "
             "ignored";
    case Kind::preset_applied:
      return "the file's preset was applied to the data: " + listed(names);
    case Kind::preset_keys_ignored:
      return "settings of the file's preset that no longer exist are ignored: " + listed(names);
    case Kind::text_ignored:
      return "Text after the last face, from line " + std::to_string(counts[0]) +
             " on, is ignored.";
    case Kind::bytes_ignored:
      return std::to_string(counts[0]) + " bytes after the last element ignored.";
    case Kind::content_misnamed:
      return "The name ends in " + names[0] + ", but the content is " + names[1] + ".";
    case Kind::settings_dropped:
      return "these settings differ from those of the first scene and are ignored: " +
             listed(names);
    case Kind::meta_missing:
      return "meta.json is missing: level 5, up -y and a black background are assumed";
    case Kind::level_missing:
      return "meta.json has no level: 5 is assumed";
    case Kind::image_size_missing:
      return "the file has no image size; " + std::to_string(counts[0]) + " x " +
             std::to_string(counts[1]) + " is assumed";
    case Kind::lens_dropped:
      return "the file's lens distortion is ignored: cameras are pinholes";
    case Kind::lens_undone:
      return "Lens distortion was removed by resampling" +
             (counts[0] + counts[1] == 0
                  ? std::string()
                  : "; up to " + std::to_string(counts[0]) + " columns and " +
                        std::to_string(counts[1]) + " rows without source pixels were cropped") +
             ".";
    case Kind::fisheye_undone:
      return "Fisheye photographs were resampled to pinhole images, at most " +
             std::to_string(std::lround(values[0])) + " degrees wide; their borders were cropped.";
    case Kind::points_missing:
      return "The file with the dataset's points is missing: " + names[0];
    case Kind::pixels_masked:
      return "Masks exclude pixels of " + std::to_string(counts[0]) + " of " +
             counted(counts[1], "photograph", "photographs") + ".";
  }
  return "";
}

}  // namespace

const char* name_of(Kind kind) { return kind_names[std::size_t(kind)]; }

std::string describe(const Remark& remark) {
  return (remark.scene.empty() ? "" : remark.scene + ": ") + sentence_of(remark);
}

std::string hint_of(const Remark& remark) {
  switch (remark.kind) {
    case Kind::up_unknown_to_format:
    case Kind::up_unknown_to_trimesh:
    case Kind::up_unknown_to_checkpoint:
    case Kind::up_unknown_to_splats:
      return "--up changes it";
    case Kind::profile_assumed:
    case Kind::render_mode_unknown:
      return "--profile changes it";
    case Kind::vertex_colors_srgb_by_generator:
    case Kind::vertex_colors_linear_by_gltf:
      return "--vertex-colors changes it";
    case Kind::octagon_q_assumed:
      return "--octagon-q changes it";
    default:
      return "";
  }
}

std::vector<std::string> described(const std::vector<Remark>& remarks) {
  std::vector<std::string> sentences;
  for (const Remark& remark : remarks) {
    const std::string hint = hint_of(remark);
    sentences.push_back(describe(remark) + (hint.empty() ? "" : "; " + hint));
  }
  return sentences;
}

}  // namespace tureen
