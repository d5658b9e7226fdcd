// Only faces that cover no pixel's centre are dropped: compared with a simple search in double
// precision, and by images that must stay identical.
#include "runtime/passes/covered_faces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "runtime/plan/face_alpha.hpp"
#include "runtime/renderer.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/renderer_of.hpp"
#include "tests/support/samples.hpp"

namespace tureen::test {
namespace covered_faces_test {

/// The number that most rasterisers have.
constexpr int subpixel_bits = 8;

FrameCamera frame_of(const Camera& camera) { return {camera, camera.eye(), {0.01, 100.0}}; }

std::vector<bool> shown(const TriangleSoup& soup, const FrameCamera& frame) {
  std::vector<std::uint32_t> faces(soup.triangles.size()), vertices;
  std::iota(faces.begin(), faces.end(), 0u);
  CoveredFaces covered(prepare_geometry(soup, faces));
  EXPECT_TRUE(covered.begin_frame(frame, subpixel_bits));
  covered.append(0, std::int32_t(3 * faces.size()), vertices);
  std::vector<bool> result(faces.size());
  EXPECT_EQ(vertices.size() % 3, 0u);
  for (std::size_t i = 0; i < vertices.size(); i += 3) {
    EXPECT_EQ(vertices[i] % 3, 0u);
    EXPECT_EQ(vertices[i + 1], vertices[i] + 1);
    EXPECT_EQ(vertices[i + 2], vertices[i] + 2);
    result[vertices[i] / 3] = true;
  }
  return result;
}

struct Found {
  bool crosses_near = false;
  bool covers = false;       // a pixel's centre
  bool comes_close = false;  // to a pixel's centre, within 0.05 pixels
};

/// Tests every centre near the face.
Found search(const TriangleSoup& soup, std::size_t face, const FrameCamera& frame) {
  Found found;
  const Camera& camera = frame.camera;
  glm::dvec2 p[3];
  for (int k = 0; k < 3; ++k) {
    const glm::dvec3 world = soup.positions[soup.triangles[face][k]];
    const glm::dvec3 view = glm::dmat3(camera.view_from_world) * (world - frame.eye);
    found.crosses_near = found.crosses_near || -view.z <= frame.range.near;
    p[k] = {camera.cx + camera.fx * view.x / -view.z,
            camera.height - camera.cy + camera.fy * view.y / -view.z};
  }
  if (found.crosses_near) return found;
  const auto bounds_of = [&](int axis, int count) {
    const auto [low, high] = std::minmax({p[0][axis], p[1][axis], p[2][axis]});
    return std::pair(int(std::clamp(std::floor(low) - 1, 0.0, double(count))),
                     int(std::clamp(std::ceil(high) + 1, 0.0, double(count))));
  };
  const auto [x_begin, x_end] = bounds_of(0, camera.width);
  const auto [y_begin, y_end] = bounds_of(1, camera.height);
  const auto cross = [](glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; };
  const double sign = cross(p[1] - p[0], p[2] - p[0]) < 0 ? -1 : 1;
  for (int y = y_begin; y < y_end; ++y)
    for (int x = x_begin; x < x_end; ++x) {
      const glm::dvec2 center(x + 0.5, y + 0.5);
      double inside = INFINITY, near = INFINITY;
      for (int k = 0; k < 3; ++k) {
        const glm::dvec2 edge = p[(k + 1) % 3] - p[k];
        const double e = sign * cross(edge, center - p[k]);
        inside = std::min(inside, e);
        near = std::min(near, e + 0.05 * (std::abs(edge.x) + std::abs(edge.y)));
      }
      found.covers = found.covers || inside >= 0;
      found.comes_close = found.comes_close || near >= 0;
    }
  return found;
}

TEST(CoveredFaces, AreThoseThatASearchFinds) {
  std::size_t covering = 0, missing = 0, dropped = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    Random random(seed);
    // From tiny faces to faces of several pixels, many of them outside the image or behind the eye.
    const double size = 0.002 * std::pow(10.0, random.uniform(0, 1.5));
    const TriangleSoup soup =
        random_soup(seed, {.faces = 2000, .size = size, .degenerate = seed % 3 == 0});
    Camera camera = random_camera(random, 160 + int(random.below(100)), 91);
    const FrameCamera frame = frame_of(camera);
    const std::vector<bool> shows = shown(soup, frame);
    for (std::size_t t = 0; t < shows.size(); ++t) {
      // Faces without area are removed earlier.
      if (!drawable(soup, std::uint32_t(t))) continue;
      const Found found = search(soup, t, frame);
      if (found.covers || found.crosses_near) {
        ASSERT_TRUE(shows[t]) << "seed " << seed << ", face " << t;
        ++covering;
      } else if (!found.comes_close) {
        ++missing;
        dropped += shows[t] ? 0 : 1;
      }
    }
  }
  EXPECT_GT(covering, 5000u);
  EXPECT_GT(missing, 20000u);
  // The other faces that are kept without need are needles longer than two pixels.
  EXPECT_GT(double(dropped), 0.9 * double(missing));
}

TEST(CoveredFaces, AreAllOnesWhoseDepthIsButARounding) {
  // Corners in the plane through the eye, up to float rounding, with a nearer near plane: in
  // floats, chance decides whether they are in front of the eye or behind it.
  const std::uint64_t seed = 13;
  Random random(seed);
  std::size_t crossing = 0;
  for (int view = 0; view < 20; ++view) {
    const Camera camera = random_camera(random, 160, 91);
    FrameCamera frame = frame_of(camera);
    frame.range = {1e-12, 100.0};
    const glm::dmat3 axes = camera.world_from_view_rotation();
    TriangleSoup soup;
    for (std::uint32_t face = 0; face < 500; ++face) {
      for (int corner = 0; corner < 3; ++corner)
        soup.positions.emplace_back(frame.eye + random.uniform(-10, 10) * axes[0] +
                                    random.uniform(-10, 10) * axes[1]);
      soup.triangles.emplace_back(3 * face, 3 * face + 1, 3 * face + 2);
    }
    const std::vector<bool> shows = shown(soup, frame);
    for (std::size_t t = 0; t < shows.size(); ++t)
      if (search(soup, t, frame).crosses_near) {
        ASSERT_TRUE(shows[t]) << "seed " << seed << ", view " << view << ", face " << t;
        ++crossing;
      }
  }
  EXPECT_GT(crossing, 5000u) << "of 10,000 faces: too few to prove anything";
}

TEST(CoveredFaces, AreAllThereIsWhereFloatsKnowTooLittle) {
  const TriangleSoup soup = random_soup(1, {.faces = 10});
  const std::vector<std::uint32_t> faces{0, 1, 2};
  CoveredFaces covered(prepare_geometry(soup, faces));
  Random random(1);
  Camera camera = random_camera(random, 320, 240);
  EXPECT_TRUE(covered.begin_frame(frame_of(camera), subpixel_bits));
  camera.fx = camera.fy = 1e6;
  EXPECT_FALSE(covered.begin_frame(frame_of(camera), subpixel_bits));
}

class CoveredFacesImage : public testing::TestWithParam<InContext<Kind>> {};

/// Views from outside, from inside, and from close by, where faces are large.
TEST_P(CoveredFacesImage, StaysTheSameToTheBit) {
  const auto& [named, kind] = GetParam();
  const gl::Context context = gl::Context::create(named.request);
  ASSERT_TRUE(context.capabilities().software);
  const std::uint64_t seed = 7;
  Random random(seed);
  TriangleSoup soup = random_soup(seed, {.kind = kind, .faces = 30000, .size = 0.01, .level = 1});
  // Faces near the ball's surface are small; one face in sixteen is large.
  for (std::size_t t = 0; t < soup.triangles.size(); t += 16)
    for (int k = 1; k < 3; ++k) {
      glm::vec3& corner = soup.positions[soup.triangles[t][k]];
      const glm::vec3 first = soup.positions[soup.triangles[t][0]];
      corner = first + 20.0f * (corner - first);
    }
  const SpecialisationSet all = SpecialisationSet::all();
  Renderer without =
      renderer_of(context, soup, glm::dvec3(0),
                  {.plan = {.specialisations = all.without(Specialisation::small_triangles)}});
  ASSERT_FALSE(without.plan().soup(0).drops_small_triangles);
  int showing = 0;
  for (int i = 0; i < 4; ++i) {
    Camera camera = random_camera(random, 200 + 37 * i, 150);
    if (i >= 2) {
      const glm::dvec3 eye = (i == 2 ? 0.4 : 1.0) * random.direction();
      camera = look_at(eye, 0.3 * random.direction(), {0, 0, 1}, 1.2, 200, 151);
    }
    // A new renderer for each view: after a frame that shows most faces, the search pauses.
    Renderer with = renderer_of(context, soup, glm::dvec3(0), {.plan = {.specialisations = all}});
    ASSERT_TRUE(with.plan().soup(0).drops_small_triangles);
    with.draw({camera});
    without.draw({camera});
    const Image8 a = with.read_color(), b = without.read_color();
    EXPECT_TRUE(a.pixels == b.pixels) << "seed " << seed << ", view " << i;
    EXPECT_EQ(faces_of(with), faces_of(without));
    with.draw({camera});  // possibly with a paused search
    EXPECT_TRUE(with.read_color().pixels == b.pixels) << "seed " << seed << ", again, view " << i;
    showing += std::any_of(a.pixels.begin(), a.pixels.end(),
                           [&](glm::u8vec4 p) { return p != a.pixels[0]; })
                   ? 1
                   : 0;
  }
  EXPECT_GE(showing, 3) << "in a view from inside, one face may fill the image";
}

// With these settings, the drawn pixels are not those of the final image.
TEST(CoveredFaces, AreFoundAmongThePixelsThatAreDrawn) {
  const std::uint64_t seed = 11;
  const gl::Context context = gl::Context::create({});
  if (!context.capabilities().software) GTEST_SKIP() << "the plan keeps such faces on a GPU";
  const TriangleSoup soup =
      random_soup(seed, {.kind = Kind::face_colors, .faces = 30000, .size = 0.01});
  Random random(seed);
  for (const Quality& quality : {Quality{.resolution_scale = 0.6}, Quality{.supersampling = 3}}) {
    const SpecialisationSet all = SpecialisationSet::all();
    Renderer with = renderer_of(context, soup, glm::dvec3(0),
                                {.plan = {.specialisations = all, .quality = quality}});
    Renderer without =
        renderer_of(context, soup, glm::dvec3(0),
                    {.plan = {.specialisations = all.without(Specialisation::small_triangles),
                              .quality = quality}});
    ASSERT_TRUE(with.plan().soup(0).drops_small_triangles);
    ASSERT_FALSE(without.plan().soup(0).drops_small_triangles);
    const Camera camera = random_camera(random, 211, 150);
    with.draw({camera});
    without.draw({camera});
    const Image8 a = with.read_color(), b = without.read_color();
    EXPECT_TRUE(a.pixels == b.pixels) << "seed " << seed;
    EXPECT_TRUE(std::any_of(a.pixels.begin(), a.pixels.end(),
                            [&](glm::u8vec4 p) { return p != a.pixels[0]; }));
  }
}

constexpr Kind image_kinds[] = {Kind::face_colors, Kind::vertex_colors, Kind::lattice_mlp};
INSTANTIATE_TEST_SUITE_P(, CoveredFacesImage, in_contexts(image_kinds), name_in_context);
INSTANTIATE_TEST_SUITE_P(Thorough, CoveredFacesImage, in_other_contexts(image_kinds),
                         name_in_context);

}  // namespace covered_faces_test
}  // namespace tureen::test
