// Every kind of every table of remarks, with the fields that its reader gives.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "formats/common/format_remarks.hpp"
#include "formats/dataset/dataset_remarks.hpp"
#include "formats/diffsoup/diffsoup_remarks.hpp"
#include "formats/gltf/gltf_remarks.hpp"
#include "formats/mesh/mesh_remarks.hpp"
#include "formats/sog/sog_remarks.hpp"
#include "formats/splat/splat_remarks.hpp"
#include "formats/torch/checkpoint_remarks.hpp"
#include "formats/tureen_glb/tureen_glb_remarks.hpp"
#include "scene/scene_remarks.hpp"

namespace tureen {
namespace remarks_test {

namespace fs = std::filesystem;

using Counts = std::vector<std::uint64_t>;
using Names = std::vector<std::string>;

const std::vector<Remark> every_kind{
    {&remarks::soft_triangles_opaque, {{"coverage", 0.333}, {"opacity", 0.5}}},
    {&remarks::soft_triangles_dropped, {{"dropped", 2}, {"all", 7}, {"smallest_opacity", 0.01}}},
    {&remarks::splats_limited, {{"kept", 2}, {"all", 7}}},
    {&remarks::settings_dropped, {{"settings", Names{"cameras", "up axis"}}}},
    {&remarks::up_unknown_to_format, {{"format", "OFF"}}},
    {&remarks::splats_dropped, {{"dropped", 1}, {"all", 7}}},
    {&remarks::bytes_ignored, {{"bytes", 3}}},
    {&remarks::content_misnamed, {{"extension", ".ply"}, {"format", "OFF"}}},
    {&remarks::mean_colors_shown, {{"extension", "TUREEN_soup"}}},
    {&remarks::up_of_no_camera, {{"axis", "-y"}}},
    {&remarks::image_size_missing, {{"width", 800}, {"height", 600}}},
    {&remarks::lens_undone, {{"columns", 0}, {"rows", 0}}},
    {&remarks::lens_undone_cropped, {{"columns", 0}, {"rows", 3}}},
    {&remarks::fisheye_undone, {{"degrees", 99.6}}},
    {&remarks::points_missing, {{"file", "sparse_pc.ply"}}},
    {&remarks::pixels_masked, {{"masked", 1}, {"all", 1}}},
    {&remarks::points_unreadable, {{"file", "a.ply"}, {"reason", "lacks 'x'"}}},
    {&remarks::points_skipped, {{"count", 1}}},
    {&remarks::points_none},
    {&remarks::photographs_skipped,
     {{"count", 2}, {"all", 9}, {"names", Names{"a.png", "b.png"}}, {"reason", "missing"}}},
    {&remarks::photographs_renamed, {{"count", 1}, {"file", "a.PNG"}, {"name", "a.png"}}},
    {&remarks::photographs_resized, {{"factor", 2}}},
    {&remarks::photographs_turned, {{"count", 2}}},
    {&remarks::orientation_ignored, {{"count", 1}}},
    {&remarks::smaller_images, {{"folder", "images_4"}}},
    {&remarks::models_several, {{"chosen", "1"}, {"count", 9}, {"others", Names{"0"}}}},
    {&remarks::split_named, {{"source", "test.txt"}, {"train", 5}, {"test", 3}, {"unused", 0}}},
    {&remarks::split_names_unknown,
     {{"source", "test.txt"}, {"count", 1}, {"names", Names{"v_77.png"}}}},
    {&remarks::split_empty, {{"source", "test.txt"}}},
    {&remarks::split_without_test, {{"count", 3}}},
    {&remarks::alpha_is_background, {{"count", 3}, {"all", 9}}},
    {&remarks::alpha_is_mask, {{"count", 3}, {"all", 9}}},
    {&remarks::alpha_ignored, {{"count", 3}, {"all", 9}}},
    {&remarks::alpha_half_restored, {{"texels", 20}, {"all", 90}}},
    {&remarks::corners_dropped, {{"corners", 4}, {"primitive", "mesh 0"}}},
    {&remarks::polygons_split, {{"polygons", 1}}},
    {&remarks::small_faces_dropped, {{"faces", 1}}},
    {&remarks::up_unknown_to_obj},
    {&remarks::points_and_lines_skipped, {{"elements", 1}}},
    {&remarks::material_library_missing, {{"library", "a.mtl"}, {"reason", "it is missing"}}},
    {&remarks::materials_missing, {{"materials", Names{"blue"}}}},
    {&remarks::texture_missing, {{"material", "red"}, {"reason", "it is missing"}}},
    {&remarks::texture_placement_dropped, {{"material", "red"}}},
    {&remarks::transparency_cut_out},
    {&remarks::color_components_clamped, {{"components", 1}}},
    {&remarks::face_colors_missing, {{"triangles", 1}}},
    {&remarks::face_colors_mapped, {{"faces", 1}}},
    {&remarks::text_ignored, {{"line", 8}}},
    {&remarks::shapes_missing, {{"shapes", Counts{1, 2, 5}}, {"all", 8}}},
    {&remarks::shapes_untextured, {{"shapes", Counts{7}}, {"all", 8}}},
    {&remarks::up_unknown_to_splats, {{"format", "PLY"}}},
    {&remarks::profile_assumed, {{"profile", "2dgs"}}},
    {&remarks::render_mode_unknown, {{"mode", "other"}, {"profile", "3dgs"}}},
    {&remarks::octagon_q_assumed, {{"q", 4.0}}},
    {&remarks::near_limit_lowered, {{"radius", 0.1}, {"published", 0.2}, {"limit", 0.01}}},
    {&remarks::near_limit_hides, {{"limit", 0.2}, {"hidden", 0.5}}},
    {&remarks::near_limit_large, {{"limit", 0.2}, {"radius", 0.1}}},
    {&remarks::turned_upright, {{"from", "-y"}, {"to", "+z"}}},
    {&remarks::filter_applied},
    {&remarks::level_chosen, {{"levels", 7}, {"level", 1}, {"splats", 250000}, {"finest", 500000}}},
    {&remarks::level_read, {{"levels", 7}, {"level", 1}, {"splats", 250000}}},
    {&remarks::splat_extensions_ignored, {{"extensions", Counts{3, 258}}}},
    {&remarks::preset_applied, {{"edits", Names{"seal", "sort"}}}},
    {&remarks::preset_keys_ignored, {{"keys", Names{"a"}}}},
    {&remarks::screen_interpolation_dropped},
    {&remarks::coordinates_rounded},
    {&remarks::up_of_transforms},
    {&remarks::up_of_cameras},
    {&remarks::lens_dropped},
    {&remarks::meta_missing},
    {&remarks::level_missing},
    {&remarks::up_unknown_to_trimesh},
    {&remarks::splat_colors_linear},
    {&remarks::spz_axes_of_draft, {{"extension", "KHR_a"}}},
    {&remarks::spz_axes_stored},
    {&remarks::extensions_dropped, {{"extensions", Names{"KHR_lights_punctual"}}}},
    {&remarks::chunks_unaligned},
    {&remarks::vertex_colors_srgb},
    {&remarks::vertex_colors_linear},
    {&remarks::vertex_colors_srgb_by_generator},
    {&remarks::vertex_colors_linear_by_gltf},
    {&remarks::colors_multiplied},
    {&remarks::materials_unlit},
    {&remarks::surfaces_split, {{"layers", Names{"chrome"}}}},
    {&remarks::surface_dropped, {{"material", "materials[0]"}, {"reason", "it is rough"}}},
    {&remarks::surface_texture_dropped, {{"material", "materials[0]"}}},
    {&remarks::blending_cut_out},
    {&remarks::animations_dropped},
    {&remarks::skins_dropped},
    {&remarks::morph_targets_dropped},
    {&remarks::points_and_lines_dropped},
    {&remarks::primitives_without_positions_dropped},
    {&remarks::other_projections_dropped},
    {&remarks::blind_cameras_dropped},
    {&remarks::face_colors_dropped},
    {&remarks::colors_missing},
    {&remarks::up_unknown_to_checkpoint},
    {&remarks::up_of_colmap_scene},
    {&remarks::up_of_synthetic_scene},
    {&remarks::preset_dropped},
};

std::size_t kinds_in(const fs::path& folder) {
  std::size_t kinds = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.path().string().ends_with("_remarks.hpp")) continue;
    std::ifstream table(entry.path());
    for (std::string line; std::getline(table, line);)
      kinds += line.starts_with("inline constexpr RemarkKind ");
  }
  return kinds;
}

TEST(Remarks, OfEveryTableAreListedHere) {
  const fs::path source(TUREEN_SOURCE_DIR);
  std::set<const RemarkKind*> listed;
  for (const Remark& remark : every_kind) listed.insert(remark.kind);
  EXPECT_EQ(listed.size(), kinds_in(source / "formats") + kinds_in(source / "scene"));
}

TEST(Remarks, HaveTheFieldsOfTheirTexts) {
  for (const Remark& remark : every_kind) {
    const std::string sentence = describe(remark);
    EXPECT_EQ(sentence.find_first_of("{|}"), sentence.npos) << sentence;
  }
}

}  // namespace remarks_test
}  // namespace tureen
