// What is drawn of a cut-out face: it holds all that exists, no more than that needs, and the
// picture is the one that whole faces give.
#include "runtime/face_part.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/renderer.hpp"
#include "soup/lattice.hpp"
#include "support/contexts.hpp"
#include "support/cutout_cloud.hpp"
#include "support/random_soups.hpp"

namespace tureen::test {
namespace {

LatticeTexture& lattice_of(TriangleSoup& soup) { return std::get<LatticeTexture>(soup.appearance); }

void set_alpha(LatticeTexture& texture, std::size_t texel, float alpha) {
  const std::size_t at = texel * LatticeTexture::channels + LatticeTexture::features;
  if (auto* bytes = std::get_if<std::vector<std::uint8_t>>(&texture.texels))
    (*bytes)[at] = std::uint8_t(std::lround(alpha * 255.0f));
  else
    std::get<std::vector<float>>(texture.texels)[at] = alpha;
}

/// Random lattices whose texels are clear out to `rim` of the way from the edges to the middle.
TriangleSoup soup_with_rims(std::uint64_t seed, int level, bool as_float, double rim) {
  TriangleSoup soup =
      random_soup(seed, {.kind = Kind::lattice_mlp, .level = level, .float_texels = as_float});
  Random random(seed + 1);
  const int n = lattice::resolution(level);
  for (const LatticePatch& patch : lattice_of(soup).patches) {
    const double width = rim * random.uniform(0.1, 1.0) / 3.0;
    for (int y = 0; y <= n; ++y)
      for (int x = 0; x + y <= n; ++x)
        if (std::min({x, y, n - x - y}) < width * n || std::min({x, y, n - x - y}) == 0)
          set_alpha(lattice_of(soup), patch.first_texel + lattice::texel_index(x, y),
                    float(random.uniform(0.0, 0.4)));
  }
  return soup;
}

double alpha_at(const LatticeTexture& texture, std::uint32_t face, glm::dvec2 b) {
  const LatticePatch& patch = texture.patches[face];
  const auto at = lattice::footprint(int(patch.level), b.x, b.y);
  double alpha = 0;
  for (int k = 0; k < 3; ++k)
    alpha += at.weights[k] *
             double(texture.value(patch.first_texel + at.texels[k], LatticeTexture::features));
  return alpha;
}

/// The least over the three edges of how far inside a point lies, in barycentrics of the face.
double inside(const FacePart& part, glm::dvec2 b) {
  return std::min({b.x - part[2].x, b.y - part[2].y, (part[0].x + part[0].y) - (b.x + b.y)});
}

class FacePartTest : public testing::TestWithParam<std::tuple<int, bool>> {};

TEST_P(FacePartTest, HoldsWhatExistsWithItsMarginAndNoMore) {
  const auto [level, as_float] = GetParam();
  const std::uint64_t seed = 7 + std::uint64_t(level);
  TriangleSoup soup = soup_with_rims(seed, level, as_float, 0.8);
  Random random(seed);
  std::size_t smaller = 0;
  for (std::uint32_t face = 0; face < soup.triangles.size(); ++face) {
    const FacePart part = existing_part(soup, lattice_of(soup), face);
    if (part == whole_face) continue;
    ++smaller;
    double nearest = 1.0;
    const auto visit = [&](glm::dvec2 b) {
      if (alpha_at(lattice_of(soup), face, b) < alpha_threshold) return;
      nearest = std::min(nearest, inside(part, b));
    };
    const int fine = std::min(16 * lattice::resolution(level), 128);
    for (int y = 0; y <= fine; ++y)
      for (int x = 0; x + y <= fine; ++x) visit(glm::dvec2(x, y) / double(fine));
    // What exists may be a corner between the points of the fine grid: a step and a half of it.
    EXPECT_GE(nearest, part_margin - 1e-9) << "face " << face << ", seed " << seed;
    EXPECT_LE(nearest, part_margin + 1.5 / fine) << "face " << face << ", seed " << seed;
  }
  EXPECT_GT(smaller, 20u);
}

INSTANTIATE_TEST_SUITE_P(Level, FacePartTest,
                         testing::Combine(testing::Values(2, 3, 4), testing::Bool()),
                         [](const auto& i) {
                           return std::to_string(std::get<0>(i.param)) +
                                  (std::get<1>(i.param) ? "Float" : "Byte");
                         });

TEST(FacePart, AFaceThatReachesAnEdgeStaysWhole) {
  TriangleSoup soup = soup_with_rims(1, 3, false, 0.8);
  const LatticePatch patch = lattice_of(soup).patches[0];
  for (std::uint32_t k = 0; k < lattice::texel_count(3); ++k)
    set_alpha(lattice_of(soup), patch.first_texel + k, 0.0f);
  set_alpha(lattice_of(soup), patch.first_texel + lattice::texel_index(3, 3), 1.0f);
  EXPECT_NE(existing_part(soup, lattice_of(soup), 0), whole_face);
  set_alpha(lattice_of(soup), patch.first_texel + lattice::texel_index(3, 0), 1.0f);
  EXPECT_EQ(existing_part(soup, lattice_of(soup), 0), whole_face);
}

/// The first face that need not be drawn whole.
std::uint32_t face_with_part(const TriangleSoup& soup, const LatticeTexture& texture) {
  std::uint32_t face = 0;
  while (existing_part(soup, texture, face) == whole_face) ++face;
  return face;
}

TEST(FacePart, FacesThatRoundingCouldChangeStayWhole) {
  TriangleSoup soup = soup_with_rims(2, 3, true, 0.8);
  const std::uint32_t face = face_with_part(soup, lattice_of(soup));
  const LatticePatch patch = lattice_of(soup).patches[face];
  for (const float alpha :
       {1e30f, std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
    TriangleSoup wild = soup;
    set_alpha(lattice_of(wild), patch.first_texel + lattice::texel_index(3, 3), alpha);
    EXPECT_EQ(existing_part(wild, lattice_of(wild), face), whole_face) << alpha;
  }
  for (glm::vec3& p : soup.positions) p += glm::vec3(1e5f, 0, 0);
  EXPECT_EQ(existing_part(soup, lattice_of(soup), face), whole_face);
}

TEST(FacePart, CoincidentFacesStayWhole) {
  TriangleSoup soup = soup_with_rims(3, 3, false, 0.8);
  for (std::size_t t = 1; t < soup.triangles.size() / 2; t += 2)
    soup.triangles[t] = soup.triangles[t - 1];
  const RenderPlan plan = make_plan(soup, DeviceLimits{});
  ASSERT_TRUE(plan.left_out.has(LeaveOut::transparent_rims));
  std::size_t pairs = 0;
  for (std::size_t slot = plan.opaque_count + 1; slot < plan.faces.size(); ++slot) {
    if (!coincident(soup, plan.faces[slot - 1], plan.faces[slot])) continue;
    ++pairs;
    EXPECT_EQ(plan.parts[slot - 1 - plan.opaque_count], whole_face);
    EXPECT_EQ(plan.parts[slot - plan.opaque_count], whole_face);
  }
  EXPECT_GT(pairs, 10u);
}

/// Pixels that name another face, and the largest difference of a channel where both name the same.
struct Difference {
  double faces = 0;
  int worst = 0;
};

Difference difference_from_whole_faces(const TriangleSoup& soup, const Camera& camera) {
  static gl::Context context = gl::Context::create({});
  context.make_current();
  const auto drawn = [&](LeaveOutSet leave_out) {
    Renderer renderer(context, soup, glm::dvec3(0),
                      {.plan = {.leave_out = leave_out, .site = ShadingSite::deferred}});
    EXPECT_EQ(renderer.plan().left_out.has(LeaveOut::transparent_rims),
              leave_out.has(LeaveOut::transparent_rims));
    renderer.draw(camera);
    return std::pair(renderer.read_faces(), renderer.read_color());
  };
  const auto [faces, color] = drawn(LeaveOutSet::all());
  const auto [whole_faces, whole_color] =
      drawn(LeaveOutSet::all().without(LeaveOut::transparent_rims));
  Difference difference;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (faces[i] != whole_faces[i]) {
      difference.faces += 1.0 / double(faces.size());
      continue;
    }
    for (int c = 0; c < 3; ++c)
      difference.worst = std::max(
          difference.worst, std::abs(int(color.pixels[i][c]) - int(whole_color.pixels[i][c])));
  }
  return difference;
}

// Depth, barycentrics and the alpha that they find are rounded from other corners: a few units in
// the last place, which decide a pixel in 10^5 or so. A sixteenth bit of a barycentric may tip.
constexpr double most_faces = 3e-5;
constexpr int worst_step = 1;

TEST(FacePart, ThePictureIsThatOfWholeFaces) {
  for (const int level : {2, 3, 5})
    for (const bool as_float : {false, true}) {
      const std::uint64_t seed = 40 + std::uint64_t(level);
      SCOPED_TRACE("level " + std::to_string(level) + ", seed " + std::to_string(seed));
      const TriangleSoup soup = soup_with_rims(seed, level, as_float, 0.8);
      Random random(seed);
      const Difference difference =
          difference_from_whole_faces(soup, random_camera(random, 640, 480));
      EXPECT_LE(difference.faces, most_faces);
      EXPECT_LE(difference.worst, worst_step);
    }
}

TEST(FacePart, ThePictureOfTheCloudIsThatOfWholeFaces) {
  for (const CloudCoverage coverage : {CloudCoverage::third, CloudCoverage::all}) {
    const Scene scene = cutout_cloud({.coverage = coverage, .width = 640, .height = 360});
    const auto& soup = std::get<TriangleSoup>(scene.primitives);
    const Difference difference = difference_from_whole_faces(soup, scene.cameras.front());
    EXPECT_LE(difference.faces, most_faces);
    EXPECT_LE(difference.worst, worst_step);
  }
}

// Faces of a few pixels and less, where the grid that corners are moved to is coarse.
TEST(FacePart, ThePictureFromAfarIsThatOfWholeFaces) {
  const Scene scene = cutout_cloud({.width = 640, .height = 360});
  const auto& soup = std::get<TriangleSoup>(scene.primitives);
  for (const double distance : {30.0, 300.0}) {
    const Camera camera =
        look_at({0, -distance, 0.3 * distance}, glm::dvec3(0), {0, 0, 1}, 0.6, 640, 360);
    const Difference difference = difference_from_whole_faces(soup, camera);
    EXPECT_LE(difference.faces, most_faces) << distance;
  }
}

}  // namespace
}  // namespace tureen::test
