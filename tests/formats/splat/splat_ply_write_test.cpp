#include <cmath>
#include <limits>

#include "formats/common/splat_activation.hpp"
#include "formats/ply_file.hpp"
#include "formats/scene_file.hpp"
#include "formats/splat/splat_ply.hpp"
#include "scene/edit/morton_order.hpp"
#include "scene/edit/moved_splats.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/formats/splat/splat_fixture.hpp"

namespace tureen {
namespace splat_ply_write_test {

using namespace test;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A value that passed through log and exp, relative to itself: the rounding of a logarithm below
/// 16 is at most 2^-21 = 4.8e-7.
constexpr double through_logarithm = 1e-6;

void expect_near_vectors(const std::vector<glm::vec3>& a, const std::vector<glm::vec3>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[i][k], b[i][k], through_logarithm * b[i][k]);
}

Scene written_and_read(const Splats& splats, std::vector<std::string>& lost) {
  Scene scene = scene_of(splats);
  scene.info.up = {0, -1, 0};
  const TemporaryFolder folder;
  lost = write_scene(scene, folder / "a.ply");
  return read_scene(folder / "a.ply");
}

TEST(SplatPlyWrite, GaussiansReadBack) {
  struct Kind {
    const char* profile;
    bool flat, turned;
  };
  for (const Kind& kind :
       {Kind{"3dgs", false, false}, Kind{"mip", false, false}, Kind{"2dgs", true, false},
        Kind{"games", true, true}, Kind{"mip", true, true}, Kind{"redisplats", true, true}})
    for (int degree = 0; degree <= 4; ++degree) {
      SCOPED_TRACE(std::string(kind.profile) + (kind.flat ? " flat " : " ") +
                   std::to_string(degree));
      Splats splats = random_gaussians(7, 20, kind.profile, degree, kind.flat);
      auto& written = std::get<Gaussians>(splats.kernel);
      written.opacity[0] = 0;
      written.opacity[1] = 1;
      written.opacity[2] = std::nextafter(1.0f, 0.0f);
      written.scales[3].x = 0;
      written.scales[4].x = std::numeric_limits<float>::denorm_min();
      sort_in_morton_order(splats);
      std::vector<std::string> lost;
      const Scene scene = written_and_read(splats, lost);
      EXPECT_THAT(lost, IsEmpty());
      const Splats& again = only_splats(scene);
      EXPECT_EQ(again.profile, splats.profile);
      EXPECT_EQ(again.color.degree, degree);
      EXPECT_EQ(again.color.coefficients, splats.color.coefficients);
      const auto& read = std::get<Gaussians>(again.kernel);
      EXPECT_EQ(read.flat, kind.flat);
      EXPECT_EQ(read.centers, written.centers);
      expect_near_vectors(read.scales, written.scales);
      for (std::size_t i = 0; i < written.opacity.size(); ++i) {
        if (kind.turned)
          EXPECT_LT(glm::length(read.rotations[i] - written.rotations[i]), 1e-6f);
        else
          EXPECT_EQ(read.rotations[i], written.rotations[i]);
        const float o = written.opacity[i];
        if (o == 0 || o == 1)
          EXPECT_EQ(read.opacity[i], o);
        else
          EXPECT_NEAR(read.opacity[i], o, through_logarithm * o);
      }
    }
}

TEST(SplatPlyWrite, NamesANearLimitThatItLoses) {
  Splats splats = random_gaussians(7, 20, "mip", 1, false);
  splats.profile.min_center_depth = 0.05f;
  std::vector<std::string> lost;
  written_and_read(splats, lost);
  EXPECT_THAT(lost, ElementsAre("PLY holds no near limit; readers use 0.2."));
  splats.profile.max_alpha = 0.5f;
  written_and_read(splats, lost);
  EXPECT_THAT(lost, ElementsAre("PLY holds no near limit; readers use 0.2.",
                                "PLY cannot hold this profile; readers use mip."));
}

TEST(SplatPlyWrite, NeuralDensitiesReadBack) {
  for (const int degree : {1, 3, 4}) {
    Splats splats = random_densities(8, 20, degree);
    sort_in_morton_order(splats);
    std::vector<std::string> lost;
    const Scene scene = written_and_read(splats, lost);
    EXPECT_THAT(lost, IsEmpty());
    const auto& written = std::get<NeuralDensities>(splats.kernel);
    const auto& read = std::get<NeuralDensities>(only_splats(scene).kernel);
    EXPECT_EQ(read.centers, written.centers);
    EXPECT_EQ(read.rotations, written.rotations);
    EXPECT_EQ(read.networks, written.networks);
    expect_near_vectors(read.semi_axes, written.semi_axes);
    // The authors' reader needs at least degree 3: zeros are added.
    const SplatColor& color = only_splats(scene).color;
    ASSERT_EQ(color.degree, std::max(degree, 3));
    const auto stored = std::size_t(harmonics::count(color.degree));
    const auto own = std::size_t(harmonics::count(degree));
    for (std::size_t i = 0; i < 20; ++i)
      for (std::size_t k = 0; k < stored; ++k)
        EXPECT_EQ(color.coefficients[i * stored + k],
                  k < own ? splats.color.coefficients[i * own + k] : glm::vec3(0.0f));
  }
}

TEST(SplatPlyWrite, WritesTheColumnsOfTheAuthors) {
  const TemporaryFolder folder;
  const auto header = [&](const Splats& splats) {
    write_scene(scene_of(splats), folder / "a.ply");
    Input input = Input::open(folder / "a.ply");
    const PlyHeader read = read_ply_header(input);
    std::vector<std::string> names;
    for (const PlyProperty& property : read.elements[0].properties)
      names.push_back("float " + property.name);
    EXPECT_EQ(input.size() - read.body, 4 * names.size() * read.elements[0].count);
    return std::pair(names, read.comments);
  };
  EXPECT_EQ(header(random_gaussians(1, 2, "3dgs", 3)),
            std::pair(splat_columns(45, 3), std::string("SplatRenderMode: default\n")));
  EXPECT_EQ(header(random_gaussians(1, 2, "mip", 0)),
            std::pair(splat_columns(0, 3), std::string("SplatRenderMode: mip\n")));
  EXPECT_EQ(header(random_gaussians(1, 2, "2dgs", 1, true)),
            std::pair(splat_columns(9, 2), std::string("SplatRenderMode: 2dgs\n")));
  EXPECT_EQ(header(random_densities(1, 2, 0)), std::pair(density_columns(), std::string()));
}

TEST(SplatPlyWrite, StoredValuesAreFinite) {
  EXPECT_EQ(float(sigmoid(double(stored_opacity(0)))), 0.0f);
  EXPECT_EQ(float(sigmoid(double(stored_opacity(1)))), 1.0f);
  EXPECT_EQ(float(std::exp(double(stored_scale(0)))), 0.0f);
  EXPECT_EQ(stored_opacity(0.5), 0.0f);
  EXPECT_TRUE(std::isfinite(stored_opacity(double(std::numeric_limits<float>::denorm_min()))));
}

TEST(SplatPlyWrite, SplatsAreMovedIntoWorldCoordinates) {
  Scene scene = scene_of(random_gaussians(1, 20, "3dgs", 1));
  scene.layers[0].world_from_layer = {{0, 2, 0, 0}, {-2, 0, 0, 0}, {0, 0, 2, 0}, {10, 20, 30, 1}};
  const TemporaryFolder folder;
  write_scene(scene, folder / "a.ply");
  const Scene read = read_scene(folder / "a.ply");
  EXPECT_EQ(read.layers[0].world_from_layer, glm::dmat4(1));
  auto moved = std::get<Splats>(scene.layers[0].primitives);
  const glm::dvec3 first(scene.layers[0].world_from_layer * glm::dvec4(center(moved, 0), 1));
  move_splats(moved, scene.layers[0].world_from_layer);
  // A coordinate of up to 64, rounded to float.
  EXPECT_LT(glm::length(center(moved, 0) - first), 1e-5);
  sort_in_morton_order(moved);
  EXPECT_EQ(std::get<Gaussians>(std::get<Splats>(read.layers[0].primitives).kernel).centers,
            std::get<Gaussians>(moved.kernel).centers);
}

TEST(SplatPlyWrite, NamesTheLosses) {
  Splats splats = random_gaussians(1, 2, "3dgs", 0);
  splats.profile.min_alpha = 0.01f;
  Scene scene = scene_of(splats, {1, 2, 3});
  scene.info.up = {0, 1, 0};
  scene.info.background = {1, 1, 1};
  scene.cameras.resize(1);
  const TemporaryFolder folder;
  EXPECT_EQ(write_scene(scene, folder / "a.ply").size(), 4u);
  scene.layers[0].world_from_layer = at_origin({1e6, 2, 3});
  EXPECT_EQ(write_scene(scene, folder / "far.ply").size(), 5u);
  Splats densities = random_densities(1, 2, 3);
  std::get<NeuralDensities>(densities.kernel).omega = 20;
  scene = scene_of(densities);
  scene.info.up = {0, -1, 0};
  EXPECT_EQ(write_scene(scene, folder / "b.ply").size(), 1u);
}

}  // namespace splat_ply_write_test
}  // namespace tureen
