// The oracle on scenes of several layers: layers at their places, the nearest of them, and one
// layer against the function for one soup.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <utility>

#include "oracle/oracle.hpp"
#include "oracle/shade.hpp"
#include "tests/support/hits_of_pixels.hpp"
#include "tests/support/random_soups.hpp"

namespace tureen {
namespace oracle_layers_test {

using oracle::Coverage;
using oracle::Hit;

Camera camera_for(std::uint64_t seed) {
  test::Random random(seed);
  return test::random_camera(random, 96, 64);
}

enum class Mirror { no, yes };

/// A rotation about a skew axis, a scale, optionally a mirror, and a translation.
glm::dmat4 similarity(double angle, double scale, const glm::dvec3& place, Mirror mirror) {
  const glm::dvec3 axes(scale, mirror == Mirror::yes ? -scale : scale, scale);
  const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), place);
  return glm::scale(glm::rotate(moved, angle, glm::dvec3(1, -2, 3)), axes);
}

/// The camera that sees a layer in its own coordinates as `camera` sees it in the world. A mirror
/// makes the view space of `camera` left-handed there, so the image of the result is mirrored: its
/// columns run from right to left.
Camera in_layer(const Camera& camera, const glm::dmat4& world_from_layer) {
  const double determinant = glm::determinant(glm::dmat3(world_from_layer));
  const double scale = std::cbrt(std::abs(determinant));
  const glm::dmat4 view_from_layer = camera.view_from_world * world_from_layer;
  Camera result = camera;
  for (int column = 0; column < 4; ++column) {
    glm::dvec3 axis = glm::dvec3(view_from_layer[column]) / scale;
    if (determinant < 0) axis.x = -axis.x;
    result.view_from_world[column] = glm::dvec4(axis, column == 3 ? 1 : 0);
  }
  if (determinant < 0) result.cx = camera.width - camera.cx;
  return result;
}

Scene scene_with(std::vector<Layer> layers) {
  Scene scene;
  scene.layers = std::move(layers);
  return scene;
}

/// The scene with only one of its layers visible.
Scene only_visible(Scene scene, std::size_t layer) {
  for (std::size_t i = 0; i < scene.layers.size(); ++i) scene.layers[i].visible = i == layer;
  return scene;
}

void expect_equal(const OracleImage& a, const OracleImage& b) {
  EXPECT_EQ(a.face, b.face);
  EXPECT_EQ(a.layer, b.layer);
  EXPECT_EQ(a.depth, b.depth);
  EXPECT_EQ(a.color.pixels, b.color.pixels);
}

// -- one layer at its place -------------------------------------------------------------------

class OracleLayer : public testing::TestWithParam<test::Kind> {
 protected:
  TriangleSoup soup_ = test::random_soup(11, {.kind = GetParam(), .faces = 150, .size = 0.25});
  Camera camera_ = camera_for(12);
};

TEST_P(OracleLayer, AloneEqualsTheSoupAtItsOrigin) {
  for (const glm::dvec3& origin : {glm::dvec3(0), glm::dvec3(0.3, -0.1, 0.2)})
    for (const Coverage coverage : {Coverage::exact, Coverage::snapped}) {
      const OracleOptions options{.rays = {.coverage = coverage}, .supersampling = 2};
      expect_equal(render_oracle(scene_of(soup_, origin), {camera_}, options),
                   render_oracle(soup_, origin, {camera_}, options));
    }
}

// Appearances are functions of layer coordinates, so a camera that moves into them sees the same.
TEST_P(OracleLayer, LooksAsItDoesInItsOwnCoordinates) {
  for (const Mirror mirror : {Mirror::no, Mirror::yes}) {
    const glm::dmat4 place = similarity(0.7, 1.3, {0.2, -0.1, 0.3}, mirror);
    const Camera inside = in_layer(camera_, place);
    const oracle::Rays rays(soup_, place, camera_), rays_inside(soup_, glm::dmat4(1.0), inside);
    EXPECT_NEAR(glm::length(rays.eye() - rays_inside.eye()), 0, 1e-12);

    std::map<std::pair<int, int>, std::vector<Hit>> hits_inside;
    test::visit_pixels(rays_inside, inside, [&](int column, int row, std::span<const Hit> hits) {
      hits_inside[{column, row}].assign(hits.begin(), hits.end());
    });
    std::size_t pixels = 0;
    double color_change = 0, point_change = 0, depth_change = 0;
    test::visit_pixels(rays, camera_, [&](int column, int row, std::span<const Hit> hits) {
      ++pixels;
      const int column_inside = mirror == Mirror::yes ? camera_.width - 1 - column : column;
      const std::vector<Hit>& others = hits_inside[{column_inside, row}];
      ASSERT_EQ(hits.size(), others.size()) << column << ", " << row;
      const glm::dvec3 to_eye = rays.to_eye(column, row);
      EXPECT_NEAR(glm::length(to_eye), 1, 1e-15);
      for (std::size_t i = 0; i < hits.size(); ++i) {
        const Hit &hit = hits[i], &other = others[i];
        ASSERT_EQ(hit.face, other.face);
        depth_change = std::max(depth_change, std::abs(hit.depth / (1.3 * other.depth) - 1));
        point_change =
            std::max({point_change, std::abs(hit.b0 - other.b0), std::abs(hit.b1 - other.b1)});
        const oracle::SurfacePoint point{hit.face, hit.b0, hit.b1};
        const glm::dvec3 change =
            oracle::color(soup_, point, to_eye, rays.eye()) -
            oracle::color(soup_, point, rays_inside.to_eye(column_inside, row), rays_inside.eye());
        for (int c = 0; c < 3; ++c) color_change = std::max(color_change, std::abs(change[c]));
      }
    });
    EXPECT_EQ(pixels, hits_inside.size());
    EXPECT_GT(pixels, 500u);
    // Faces seen edge-on magnify rounding, to 3e-13 here and at most 1e-12 with 11 other seeds. The
    // limit is four times that. Colours of the same point change by at most 8e-16.
    EXPECT_LT(depth_change, 4e-12);
    EXPECT_LT(point_change, 4e-12);
    EXPECT_LT(color_change, 1e-14);
  }
}

// [G3] Layer and camera far from the world's origin.
TEST_P(OracleLayer, DoesNotChangeWhenItMovesWithTheCamera) {
  const glm::dmat4 place = similarity(0.7, 1.3, {0.2, -0.1, 0.3}, Mirror::yes);
  Scene scene = scene_of(soup_);
  scene.layers[0].world_from_layer = place;
  const OracleImage here = render_oracle(scene, {camera_});
  const glm::dvec3 offset = std::ldexp(1.0, 20) * glm::dvec3(1, -1, 1);
  Camera moved = camera_;
  moved.view_from_world = glm::translate(camera_.view_from_world, -offset);
  scene.layers[0].world_from_layer = glm::translate(glm::dmat4(1.0), offset) * place;
  const OracleImage there = render_oracle(scene, {moved});
  EXPECT_EQ(here.face, there.face);
  // The reason for this limit is in OracleImages.DoNotChangeWhenSceneAndCameraMoveTogether.
  for (std::size_t i = 0; i < here.face.size(); ++i)
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(here.color.pixels[i][c], there.color.pixels[i][c], 1e-5) << i;
}

INSTANTIATE_TEST_SUITE_P(Of, OracleLayer, testing::ValuesIn(test::all_kinds),
                         [](const auto& i) { return to_string(i.param); });

// A turn by a right angle, a scale of 2 and a mirror have no rounding: the same transform in the
// vertices gives the same image. Appearances that depend on the view direction would turn with the
// layer and not with the vertices.
TEST(OracleLayerWithoutViewDependence, EqualsTheSoupWithTransformedVertices) {
  const Camera camera = camera_for(12);
  const glm::dvec3 origin(0.3, -0.1, 0.2);
  for (const test::Kind kind : {test::Kind::face_colors, test::Kind::vertex_colors,
                                test::Kind::lattice, test::Kind::uv_textures})
    for (const double sign : {1.0, -1.0}) {
      const TriangleSoup soup = test::random_soup(11, {.kind = kind, .faces = 150, .size = 0.25});
      glm::dmat4 place = at_origin(origin);
      place[0] = {0, 0, 2, 0};
      place[1] = {0, 2 * sign, 0, 0};
      place[2] = {-2, 0, 0, 0};
      TriangleSoup baked = soup;
      for (glm::vec3& p : baked.positions) p = glm::vec3(glm::dmat3(place) * glm::dvec3(p));
      Scene scene = scene_of(soup);
      scene.layers[0].world_from_layer = place;
      for (const Coverage coverage : {Coverage::exact, Coverage::snapped}) {
        const OracleOptions options{.rays = {.coverage = coverage}};
        const OracleImage image = render_oracle(scene, {camera}, options);
        expect_equal(image, render_oracle(baked, origin, {camera}, options));
      }
    }
}

// -- several layers ---------------------------------------------------------------------------

/// Two soups with networks of their own at different levels, and between them a third, turned,
/// mirrored and scaled.
Scene three_layers() {
  const auto soup = [](std::uint64_t seed, test::Kind kind, int level) {
    return test::random_soup(seed, {.kind = kind, .faces = 80, .size = 0.25, .level = level});
  };
  return scene_with({{.name = "coarse",
                      .world_from_layer = at_origin({0.1, 0.2, -0.1}),
                      .primitives = soup(21, test::Kind::lattice_mlp, 1)},
                     {.name = "between",
                      .world_from_layer = similarity(2.1, 0.6, {-0.2, 0.1, 0.1}, Mirror::yes),
                      .primitives = soup(22, test::Kind::vertex_harmonics, -1)},
                     {.name = "fine",
                      .world_from_layer = similarity(-0.8, 1.4, {0.1, -0.3, 0.2}, Mirror::no),
                      .primitives = soup(23, test::Kind::lattice_mlp, 4)}});
}

TEST(OracleLayers, EveryPixelIsThatOfTheNearestLayer) {
  const Scene scene = three_layers();
  const Camera camera = camera_for(24);
  for (const Coverage coverage : {Coverage::exact, Coverage::snapped}) {
    const OracleOptions options{.rays = {.coverage = coverage}};
    const OracleImage image = render_oracle(scene, {camera}, options);
    std::vector<OracleImage> alone;
    for (std::size_t i = 0; i < 3; ++i)
      alone.push_back(render_oracle(only_visible(scene, i), {camera}, options));

    std::array<std::size_t, 3> shown{};
    std::size_t contested = 0;  // pixels that several layers cover
    for (std::size_t pixel = 0; pixel < image.face.size(); ++pixel) {
      std::size_t nearest = 0;
      int layers = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        layers += alone[i].face[pixel] != OracleImage::no_face;
        if (alone[i].depth[pixel] < alone[nearest].depth[pixel]) nearest = i;
      }
      ASSERT_EQ(image.face[pixel], alone[nearest].face[pixel]);
      ASSERT_EQ(image.depth[pixel], alone[nearest].depth[pixel]);
      ASSERT_EQ(image.color.pixels[pixel], alone[nearest].color.pixels[pixel]);
      if (layers == 0) continue;
      ASSERT_EQ(image.layer[pixel], nearest);
      ++shown[nearest];
      contested += layers > 1;
    }
    for (const std::size_t pixels : shown) EXPECT_GT(pixels, 100u);
    EXPECT_GT(contested, 500u);
  }
}

TEST(OracleLayers, InvisibleLayersAreSkipped) {
  const Scene scene = three_layers();
  const Camera camera = camera_for(24);
  for (std::uint32_t i = 0; i < 3; ++i) {
    OracleImage expected = render_oracle(scene_with({scene.layers[i]}), {camera});
    for (std::size_t pixel = 0; pixel < expected.face.size(); ++pixel)
      if (expected.face[pixel] != OracleImage::no_face) expected.layer[pixel] = i;
    expect_equal(render_oracle(only_visible(scene, i), {camera}), expected);
  }
  // An invisible layer may even hold primitives that the oracle cannot draw.
  Scene soft = only_visible(scene, 0);
  soft.layers[1].primitives = Splats{};
  expect_equal(render_oracle(soft, {camera}), render_oracle(only_visible(scene, 0), {camera}));
}

TEST(OracleLayers, SupersamplingShowsTheLayersOfAFinerImage) {
  const Scene scene = three_layers();
  const Camera camera = camera_for(24);
  const OracleImage fine = render_oracle(scene, {resized(camera, 192, 128)});
  const OracleImage coarse = render_oracle(scene, {camera}, {.supersampling = 2});
  EXPECT_EQ(coarse.face, fine.face);
  EXPECT_EQ(coarse.layer, fine.layer);
  EXPECT_EQ(coarse.depth, fine.depth);
}

TEST(OracleLayers, AtEqualDepthTheEarlierLayerWinsThenTheLowerFace) {
  const auto opaque = [](const glm::vec3& color) {
    TriangleSoup soup = test::random_soup(41, {.faces = 40, .size = 0.4});
    soup.appearance = FaceColors{std::vector(80, glm::vec4(color, 1))};
    for (std::uint32_t t = 0; t < 40; ++t) soup.triangles.push_back(soup.triangles[t]);
    return soup;
  };
  const glm::dmat4 place = similarity(0.7, 1.3, {0.2, -0.1, 0.3}, Mirror::yes);
  const Layer red{.world_from_layer = place, .primitives = opaque({1, 0, 0})};
  const Layer blue{.world_from_layer = place, .primitives = opaque({0, 0, 1})};
  const Camera camera = camera_for(42);
  for (const Coverage coverage : {Coverage::exact, Coverage::snapped})
    for (const bool red_first : {true, false}) {
      const Scene scene = red_first ? scene_with({red, blue}) : scene_with({blue, red});
      const OracleImage image = render_oracle(scene, {camera}, {.rays = {.coverage = coverage}});
      std::size_t pixels = 0;
      for (std::size_t i = 0; i < image.face.size(); ++i) {
        if (image.face[i] == OracleImage::no_face) continue;
        ++pixels;
        ASSERT_EQ(image.layer[i], 0u);
        ASSERT_LT(image.face[i], 40u);
        ASSERT_EQ(image.color.pixels[i], red_first ? glm::vec4(1, 0, 0, 1) : glm::vec4(0, 0, 1, 1));
      }
      EXPECT_GT(pixels, 500u);
    }
}

// Holes of the nearer layer show the farther one.
TEST(OracleLayers, TransparentFragmentsShowTheLayerBehind) {
  const auto square = [](float depth, const glm::vec4& color) {
    TriangleSoup soup;
    soup.positions = {{-9, -9, -depth}, {9, -9, -depth}, {9, 9, -depth}, {-9, 9, -depth}};
    soup.triangles = {{0, 1, 2}, {0, 2, 3}};
    soup.appearance = FaceColors{{color, glm::vec4(glm::vec3(color), 1)}};
    return soup;
  };
  const Scene scene = scene_with(
      {{.primitives = square(3, {0, 1, 0, 1})}, {.primitives = square(2, {1, 0, 0, 0})}});
  const Camera camera = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0.7, 16, 16);
  const OracleImage image = render_oracle(scene, {camera});
  // Below the diagonal, and on it: its centres belong to the face on its right.
  EXPECT_EQ(std::count(image.layer.begin(), image.layer.end(), 0u), 16 * 17 / 2);
  EXPECT_EQ(std::count(image.face.begin(), image.face.end(), OracleImage::no_face), 0);
}

// The near plane belongs to the frame: that of a small layer is also that of a vast one.
TEST(OracleLayers, ShareOneNearPlane) {
  TriangleSoup triangle;
  triangle.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  triangle.triangles = {{0, 1, 2}};
  triangle.appearance = FaceColors{{glm::vec4(1)}};
  const Camera camera = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 0.7, 16, 16);
  // Of 1e9 in size: alone, its near plane is at least at 1.
  const Layer vast{.world_from_layer = similarity(0, 1e9, {0, 0, -0.5}, Mirror::no),
                   .primitives = triangle};
  const Layer close{.world_from_layer = similarity(0, 0.05, {0, 0, -0.4}, Mirror::no),
                    .primitives = triangle};
  const Scene both = scene_with({vast, close});
  const auto covered = [&](const Scene& scene) {
    const OracleImage image = render_oracle(scene, {camera});
    return image.face.size() -
           std::size_t(std::count(image.face.begin(), image.face.end(), OracleImage::no_face));
  };
  EXPECT_EQ(covered(only_visible(both, 0)), 0u);
  EXPECT_LT(covered(only_visible(both, 1)), 256u);
  EXPECT_EQ(covered(both), 256u);
}

TEST(OracleLayers, NoVisibleLayerIsBackground) {
  const Camera camera = camera_for(24);
  Scene hidden = three_layers();
  for (Layer& layer : hidden.layers) layer.visible = false;
  for (const Scene& scene : {hidden, Scene{}}) {
    const OracleImage image = render_oracle(scene, {camera}, {.background = glm::vec3(0.5f)});
    for (std::size_t i = 0; i < image.face.size(); ++i) {
      ASSERT_EQ(image.face[i], OracleImage::no_face);
      ASSERT_EQ(image.color.pixels[i], glm::vec4(0.5f, 0.5f, 0.5f, 1));
    }
  }
}

}  // namespace oracle_layers_test
}  // namespace tureen
