// The example soup inside the repository is the one that its generator makes. Light and training
// take a minute and are not repeated; geometry, levels, cut-outs and gloss are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>

#include "formats/scene_file.hpp"
#include "soup/lattice.hpp"
#include "soup/lint.hpp"
#include "still_life.hpp"

namespace tureen {
namespace {

const std::filesystem::path file = std::filesystem::path(TUREEN_SOURCE_DIR) / "examples/soup.glb";

const Scene& scene() {
  static const Scene read = read_scene(file);
  return read;
}

TEST(ShippedSoup, LoadsWithoutNotesOrLint) {
  ASSERT_TRUE(std::holds_alternative<TriangleSoup>(scene().primitives));
  const auto& soup = std::get<TriangleSoup>(scene().primitives);
  EXPECT_FALSE(defect(soup));
  EXPECT_THAT(lint(soup).sentences, testing::IsEmpty());
  EXPECT_THAT(scene().info.notes, testing::IsEmpty());
  EXPECT_EQ(scene().info.up, glm::vec3(0, 1, 0));
  EXPECT_GE(scene().cameras.size(), 3u);
  EXPECT_LT(std::filesystem::file_size(file), 1'500'000u);
}

TEST(ShippedSoup, IsWhatItsGeneratorMakes) {
  const auto& soup = std::get<TriangleSoup>(scene().primitives);
  const auto& lattice = std::get<LatticeTexture>(soup.appearance);
  const example::Model model = example::still_life();
  ASSERT_EQ(soup.triangles.size(), model.faces.size());
  ASSERT_FALSE(lattice.is_float());
  ASSERT_TRUE(lattice.mlp);
  std::size_t different = 0, texels = 0;
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    const example::Face& face = model.faces[f];
    // Floats of size 3 or less, from sines that another library may round otherwise.
    for (int i = 0; i < 3; ++i)
      ASSERT_LT(glm::distance(glm::dvec3(soup.positions[soup.triangles[f][i]]), face.corners[i]),
                1e-6)
          << "face " << f;
    ASSERT_EQ(lattice.patches[f].level, static_cast<std::uint32_t>(face.level)) << "face " << f;
    for (std::uint32_t i = 0; i < lattice::texel_count(face.level); ++i) {
      const auto [x, y] = lattice::texel_coordinates(i);
      const auto at = model.point(face.surface, model.texel_uv(face, x, y));
      const auto paint = model.paint(at, face.surface);
      const std::size_t texel = lattice.patches[f].first_texel + i;
      ++texels;
      different += std::abs(lattice.value(texel, 3) - paint.gloss) > 1.0 / 255 ||
                   std::abs(lattice.value(texel, 7) - paint.alpha) > 1.0 / 255;
    }
  }
  // A texel may sit where a pattern breaks off (a seam, the end of a stalk) and fall to either
  // side.
  EXPECT_LT(different, texels / 1000);
}

}  // namespace
}  // namespace tureen
