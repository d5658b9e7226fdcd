// Frames of several layers, against the oracle and against frames of single layers.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "base/error.hpp"
#include "formats/scene_file.hpp"
#include "tests/support/agreement.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/debug_view_renderer.hpp"
#include "tests/support/golden.hpp"
#include "tests/support/golden_scenes.hpp"
#include "tests/support/made_once.hpp"
#include "tests/support/renderer_of.hpp"
#include "tests/support/samples.hpp"

namespace tureen::test {
namespace layers_test {

Renderer renderer_of_scene(const gl::Context& context, const Scene& scene,
                           const RenderOptions& options = {}) {
  return Renderer(context, prepare_scene(scene, device_limits(context.capabilities()), options),
                  options);
}

/// The index of a face among the faces of all layers; no_face stays.
std::uint32_t numbered(const Scene& scene, std::uint32_t layer, std::uint32_t face) {
  if (face == no_face) return no_face;
  for (std::uint32_t i = 0; i < layer; ++i)
    face += std::uint32_t(std::get<TriangleSoup>(scene.layers[i].primitives).triangles.size());
  return face;
}

Drawn drawn(const Scene& scene, Renderer& renderer, const Camera& camera) {
  renderer.draw({camera});
  Drawn result{renderer.read_color(), {}};
  for (const VisibleFace& visible : renderer.read_faces())
    result.faces.push_back(numbered(scene, visible.layer, visible.face));
  return result;
}

OracleImage expected(const Scene& scene, const Camera& camera) {
  OracleImage image =
      render_oracle(scene, {camera}, {.rays = {.coverage = oracle::Coverage::snapped}});
  for (std::size_t i = 0; i < image.face.size(); ++i)
    image.face[i] = numbered(scene, image.layer[i], image.face[i]);
  return image;
}

class Layers : public testing::TestWithParam<NamedContext> {
 protected:
  gl::Context context = gl::Context::create(GetParam().request);
};

TEST_P(Layers, AgreeWithTheOracle) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    const Scene scene = layered_scene(seed);
    const Camera& camera = scene.cameras.front();
    for (const bool reversed : {false, true}) {
      Renderer renderer = renderer_of_scene(context, scene, {.plan = {.reversed_depth = reversed}});
      const OracleImage& oracle = made_once(seed, [&] { return expected(scene, camera); });
      const Drawn image = drawn(scene, renderer, camera);
      const std::string what =
          "seed " + std::to_string(seed) + (reversed ? " reversed" : " ordinary");
      // Rounding to 8 bits gives 58.9 dB. Faces of different layers cross each other: near the
      // crossings their depths are indistinguishable in 24 bits.
      expect_agreement(oracle, image, what, {.max_face_mismatch = 2e-4, .min_psnr = 57.0});
      EXPECT_LE(agreement(oracle, image).percentile_999, 1.0 / 255) << what;
    }
  }
}

TEST_P(Layers, OneVisibleLayerIsDrawnAsAlone) {
  Scene scene = layered_scene(5);
  for (std::size_t shown = 0; shown < scene.layers.size(); ++shown) {
    for (std::size_t i = 0; i < scene.layers.size(); ++i) scene.layers[i].visible = i == shown;
    Scene alone;
    alone.layers.push_back(scene.layers[shown]);
    // Deferred as all layers are: forward colours may differ by a rounding.
    const RenderOptions options{.plan = {.site = ShadingSite::deferred}};
    Renderer among = renderer_of_scene(context, scene, options);
    Renderer one = renderer_of_scene(context, alone, options);
    among.draw({scene.cameras.front()});
    one.draw({scene.cameras.front()});
    EXPECT_EQ(among.read_color().pixels, one.read_color().pixels) << "layer " << shown;
  }
}

TEST_P(Layers, MayBeAddedRemovedAndSwapped) {
  const Scene scene = layered_scene(6);
  const FrameInput input{scene.cameras.front()};
  const DeviceLimits limits = device_limits(context.capabilities());
  const auto image_of = [&](std::vector<std::size_t> layers) {
    Scene part;
    for (const std::size_t i : layers) part.layers.push_back(scene.layers[i]);
    Renderer renderer = renderer_of_scene(context, part, {.plan = {.site = ShadingSite::deferred}});
    renderer.draw(input);
    return std::pair(renderer.read_color().pixels, renderer.read_faces());
  };
  const auto image = [&](Renderer& renderer) {
    renderer.draw(input);
    return std::pair(renderer.read_color().pixels, renderer.read_faces());
  };
  const auto prepared = [&](std::size_t layer) {
    const std::vector<PlacedLayer> all = placed_layers(scene);
    return prepare_scene(std::span(&all[layer], 1), limits);
  };
  Renderer renderer(context, prepared(0));
  EXPECT_EQ(image(renderer).first, image_of({0}).first);
  renderer.add_layers(prepared(1));
  EXPECT_EQ(image(renderer), image_of({0, 1})) << "one added";
  renderer.add_layers(prepared(2));
  EXPECT_EQ(image(renderer), image_of({0, 1, 2})) << "two added";
  const std::size_t bytes = renderer.device_bytes();
  renderer.swap_layers(0, 2);
  EXPECT_EQ(image(renderer), image_of({2, 1, 0})) << "swapped";
  renderer.remove_layer(1);
  EXPECT_EQ(image(renderer), image_of({2, 0})) << "one removed";
  EXPECT_LT(renderer.device_bytes(), bytes);
  renderer.remove_layer(0);
  EXPECT_EQ(image(renderer), image_of({0})) << "one left";
  renderer.remove_layer(0);
  renderer.set_background(glm::vec4(1.0f));
  renderer.draw(input);
  EXPECT_EQ(renderer.read_color().at(3, 5), glm::u8vec4(255)) << "none left";
  renderer.add_layers(prepared(2));
  Renderer other(context, prepared(0));
  other.leave_context();
  renderer.add_layers(std::move(other));
  renderer.set_background(glm::vec4(0, 0, 0, 1));
  EXPECT_EQ(image(renderer), image_of({2, 0})) << "added again";
}

TEST_P(Layers, MoveWithTheirPlace) {
  Scene scene = layered_scene(7);
  Renderer renderer = renderer_of_scene(context, scene);
  renderer.draw({scene.cameras.front()});
  for (Layer& layer : scene.layers)
    layer.world_from_layer = glm::rotate(glm::dmat4(1), 0.4, glm::dvec3(0, 1, 0)) *
                             glm::translate(glm::dmat4(1), glm::dvec3(0.1, 0.2, 0)) *
                             layer.world_from_layer;
  for (std::size_t i = 0; i < scene.layers.size(); ++i)
    renderer.place_layer(i, scene.layers[i].world_from_layer);
  Renderer there = renderer_of_scene(context, scene);
  renderer.draw({scene.cameras.front()});
  there.draw({scene.cameras.front()});
  EXPECT_EQ(renderer.read_color().pixels, there.read_color().pixels);
}

/// One triangle that covers the image, in one colour.
TriangleSoup wall(glm::vec4 color) {
  TriangleSoup soup;
  soup.positions = {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
  soup.triangles = {{0, 1, 2}};
  soup.appearance = FaceColors{{color}};
  return soup;
}

TEST_P(Layers, TheEarlierOneIsVisibleAtEqualDepth) {
  Scene scene;
  for (const glm::vec4 color : {glm::vec4(1, 0, 0, 1), glm::vec4(0, 1, 0, 1)})
    scene.layers.push_back({.primitives = wall(color)});
  Renderer renderer = renderer_of_scene(context, scene);
  const FrameInput input{look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.8, 32, 32)};
  renderer.draw(input);
  EXPECT_EQ(renderer.read_color().at(16, 16), glm::u8vec4(255, 0, 0, 255));
  EXPECT_EQ(renderer.read_faces()[16 * 32 + 16], (VisibleFace{0, 0}));
  renderer.swap_layers(0, 1);
  renderer.draw(input);
  EXPECT_EQ(renderer.read_color().at(16, 16), glm::u8vec4(0, 255, 0, 255));
}

TEST_P(Layers, APointIsThatOfTheNearestLayer) {
  Scene scene;
  for (const double z : {0.0, 1.0})
    scene.layers.push_back(
        {.world_from_layer = at_origin({0, 0, z}), .primitives = wall(glm::vec4(1))});
  Renderer renderer = renderer_of_scene(context, scene);
  renderer.draw({look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.8, 32, 32)});
  const auto point = renderer.point_at({16, 16});
  ASSERT_TRUE(point.has_value());
  EXPECT_NEAR(point->z, 1.0, 1e-3);
  renderer.show_layer(1, false);
  renderer.draw({look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.8, 32, 32)});
  EXPECT_NEAR(renderer.point_at({16, 16}).value().z, 0.0, 1e-3);
}

TEST_P(Layers, OneFarAwayHidesNoOther) {
  Scene scene;
  scene.layers.push_back({.primitives = wall(glm::vec4(0, 1, 0, 1))});
  for (const double distance : {1e6, 1e12, 1e30}) {
    Scene both = scene;
    both.layers.push_back({.world_from_layer = at_origin({distance, 0, -distance}),
                           .primitives = wall(glm::vec4(1, 0, 0, 1))});
    Renderer renderer = renderer_of_scene(context, both);
    renderer.draw({look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 0.8, 32, 32)});
    EXPECT_EQ(renderer.read_color().at(16, 16), glm::u8vec4(0, 255, 0, 255)) << distance;
  }
}

TEST_P(Layers, AreFilteredAndLeaveTheContext) {
  const Scene scene = layered_scene(8);
  for (const Quality quality : {Quality{.supersampling = 2}, Quality{.resolution_scale = 0.5}}) {
    Renderer renderer = renderer_of_scene(context, scene, {.plan = {.quality = quality}});
    renderer.draw({scene.cameras.front()});
    const Image8 image = renderer.read_color();
    renderer.leave_context();
    renderer.draw({scene.cameras.front()});
    EXPECT_EQ(renderer.read_color().pixels, image.pixels);
    for (std::size_t i = 0; i < scene.layers.size(); ++i) renderer.remove_layer(0);
    EXPECT_TRUE(renderer.read_faces().empty()) << "of layers that are gone";
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, 1, 1);
    renderer.set_background(glm::vec4(1.0f));
    renderer.draw({scene.cameras.front()});
    EXPECT_EQ(renderer.read_color().at(9, 9), glm::u8vec4(255)) << "no layer, foreign state";
  }
}

TEST_P(Layers, HaveDebugViewsInWorldCoordinates) {
  const FrameInput input{layered_scene(9).cameras.front()};
  for (const DebugView what : {DebugView::depth, DebugView::normals, DebugView::triangle_id,
                               DebugView::overdraw, DebugView::wireframe}) {
    // A rotated, mirrored and scaled layer, and the same triangles moved by the transform.
    Scene placed;
    placed.layers.push_back(layered_scene(9).layers.back());
    glm::dmat4& place = placed.layers[0].world_from_layer;
    // The scale of depth depends on a box along the axes of the layer.
    if (what == DebugView::depth)
      place = glm::scale(at_origin({0.3, -0.2, 0.1}), glm::dvec3(-0.7, 0.7, 0.7));
    Scene moved = placed;
    for (glm::vec3& p : std::get<TriangleSoup>(moved.layers[0].primitives).positions)
      p = glm::vec3(place * glm::dvec4(glm::dvec3(p), 1.0));
    moved.layers[0].world_from_layer = glm::dmat4(1.0);
    Image8 images[2];
    for (int i = 0; i < 2; ++i) {
      const std::vector<PlacedLayer> layers = placed_layers(i == 0 ? placed : moved);
      DebugViews views(layers);
      Renderer renderer(context,
                        prepare_debug_views(layers, device_limits(context.capabilities())));
      views.show(renderer, what);
      renderer.draw(input);
      images[i] = renderer.read_color();
    }
    std::size_t off = 0;
    for (std::size_t p = 0; p < images[0].pixels.size(); ++p)
      for (int c = 0; c < 3; ++c)
        // The wireframe also shows colours, which depend on the direction in layer coordinates.
        off += std::abs(int(images[0].pixels[p][c]) - int(images[1].pixels[p][c])) >
               (what == DebugView::wireframe ? 255 : 1);
    // Corners are rounded to floats once more: some move to another 1/256 of a pixel.
    EXPECT_LE(double(off), 0.01 * double(images[0].pixels.size())) << name_of(what);
  }
}

// LayersGolden draws layers in all contexts.
INSTANTIATE_TEST_SUITE_P(All, Layers, in_osmesa(), context_name);
INSTANTIATE_TEST_SUITE_P(Thorough, Layers, in_the_others(), context_name);

TEST(LayersGolden, OneTurnedMirroredAndSmaller) {
  const Scene scene =
      golden_layers(read_scene(std::string(TUREEN_SOURCE_DIR) + "/examples/soup.glb"));
  for (const NamedContext& named : every_context) {
    const gl::Context context = gl::Context::create(named.request);
    Renderer renderer = renderer_of_scene(
        context, scene,
        {.plan = {.reversed_depth = false}, .background = glm::vec4(scene.info.background, 1.0f)});
    renderer.draw({scene.cameras.front()});
    const bool is_reference = named.request.backend == gl::Backend::osmesa;
    expect_golden(renderer.read_color(), "layers", is_reference ? "" : named.name);
  }
}

TEST(LayerCount, HasALimit) {
  const TriangleSoup soup = wall(glm::vec4(1));
  const std::vector<PlacedLayer> most(max_layers, {.soup = &soup}), more(256, {.soup = &soup});
  EXPECT_EQ(make_plan(most, {}).layers.size(), 255u);
  EXPECT_THROW(make_plan(more, {}), UsageError);
}

}  // namespace layers_test
}  // namespace tureen::test
