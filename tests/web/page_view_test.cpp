// The page's view without a browser: the device follows the document, lacks only layers that
// return, and after undos and redos all is as before.
#include "web/engine/page_view.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>
#include <glm/geometric.hpp>

#include "base/error.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen::web {
namespace page_view_test {

using testing::ElementsAre;
using testing::IsEmpty;

/// What a user sees of the documents.
bool same(const Document& a, const Document& b) {
  return a.up == b.up && a.quality == b.quality && a.background == b.background &&
         std::equal(a.layers.begin(), a.layers.end(), b.layers.begin(), b.layers.end(),
                    [](const DocumentLayer& x, const DocumentLayer& y) {
                      return x.id == y.id && x.name == y.name && x.visible == y.visible &&
                             x.bounds.low == y.bounds.low && x.bounds.high == y.bounds.high &&
                             x.world_from_layer == y.world_from_layer;
                    });
}

/// A soup, splats and a mesh with textures. `sources`: what a page would read again.
struct PageViews : testing::Test {
  PageViews() {
    Scene scene;
    for (Primitives primitives :
         {Primitives(test::random_soup(1, {.kind = test::Kind::lattice})),
          Primitives(test::random_splats(test::splat_kinds[1], 50, 0.1, 2)),
          Primitives(test::random_soup(3, {.kind = test::Kind::uv_textures}))}) {
      scene.layers.push_back({.primitives = primitives});
      kept.push_back(std::move(primitives));
    }
    view.smooth_at_rest(false);
    view.set_viewport(64, 48);
    ShownScene shown{
        .subject = subject_of(scene), .cameras = {}, .names = {"soup", "splats", "mesh"}};
    std::vector<PlacedLayer> layers;
    for (const Primitives& each : kept) layers.push_back(placed_layer(each, {}));
    view.show(prepare_scene(layers, limits(), RenderOptions{}), shown);
    for (std::size_t i = 0; i < kept.size(); ++i) sources[id(i)] = &kept[i];
  }
  DeviceLimits limits() const { return device_limits(view.capabilities()); }
  LayerId id(std::size_t layer) const { return view.document().layers[layer].id; }
  PreparedScene prepared(const Primitives& primitives) const {
    const PlacedLayer placed = placed_layer(primitives, {});
    return prepare_scene(std::span(&placed, 1), limits(), RenderOptions{});
  }
  void upload_again(const std::vector<LayerId>& layers) {
    for (const LayerId layer : layers) view.upload_again(prepared(*sources.at(layer)), layer);
  }
  /// Goes to a step. Returns the layers that were uploaded.
  std::vector<LayerId> go_to(std::size_t position) {
    const std::vector<LayerId> missing = view.go_to(position);
    upload_again(missing);
    EXPECT_THAT(view.go_to(position), IsEmpty());
    EXPECT_EQ(view.history().position(), position);
    EXPECT_THAT(view.missing(), IsEmpty());
    return missing;
  }
  std::vector<LayerId> undo() { return go_to(view.history().position() - 1); }
  void add(const std::string& name, const Primitives& primitives) {
    const Primitives& added = kept.emplace_back(primitives);
    view.upload(prepared(added), name);
    for (const LayerId layer : view.add_uploaded(true)) sources[layer] = &added;
  }
  std::vector<std::string> steps() const {
    std::vector<std::string> names;
    for (const History::Step& step : view.history().steps()) names.push_back(step.name);
    return names;
  }
  Image8 image() { return view.image(64, 48); }
  /// The document, prepared anew, from the same camera.
  Image8 expected() {
    std::vector<PlacedLayer> layers;
    for (const DocumentLayer& layer : view.document().layers)
      layers.push_back(placed_layer(*sources.at(layer.id), layer));
    Renderer renderer(view.context(), prepare_scene(layers, limits(), RenderOptions{}));
    renderer.set_background(glm::vec4(view.background(), 1.0f));
    renderer.draw({view.controls().camera(64, 48)});
    return renderer.read_color();
  }

  PageView view{gl::Context::create(test::osmesa), SplatBlending::automatic,
                [] { return std::unique_ptr<SplatSorter>(); }};
  std::deque<Primitives> kept;
  std::map<LayerId, const Primitives*> sources;
};

TEST_F(PageViews, UploadOnlyWhatTheDeviceLacks) {
  const std::size_t bytes = view.renderer()->device_bytes();
  const LayerId soup = id(0), splats = id(1), mesh = id(2);
  view.place_layer(soup, at_origin({0.2, 0, 0}));
  view.show_layer(splats, false);
  view.move_layer(mesh, 0);
  EXPECT_THAT(view.missing(), IsEmpty());
  EXPECT_EQ(view.renderer()->device_bytes(), bytes);
  EXPECT_EQ(image().pixels, expected().pixels);
  view.remove_layer(soup);
  EXPECT_LT(view.renderer()->device_bytes(), bytes);
  EXPECT_EQ(image().pixels, expected().pixels);
  EXPECT_THAT(steps(), ElementsAre("Move soup", "Hide splats", "Reorder mesh", "Remove soup"));
  EXPECT_THAT(view.go_to(3), ElementsAre(soup));
  EXPECT_EQ(view.history().position(), 4u) << "nothing has changed";
  EXPECT_THAT(go_to(3), ElementsAre(soup));
  EXPECT_EQ(view.renderer()->device_bytes(), bytes);
  EXPECT_THAT(go_to(0), IsEmpty());
  EXPECT_EQ(image().pixels, expected().pixels);
}

TEST_F(PageViews, RandomEditsUndosAndRedosEndEqual) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    test::Random random(seed);
    view.forget_steps();
    const Image8 before = image();
    std::vector<Document> states{view.document()};  // at each position of the history
    for (int i = 0; i < 300; ++i) {
      const std::size_t count = view.document().layers.size(), position = view.history().position();
      const LayerId any = id(random.below(std::uint32_t(count)));
      switch (random.below(9)) {
        case 0:
        case 1:
          if (position > 0) undo();
          break;
        case 2:
          if (position < view.history().steps().size()) go_to(position + 1);
          break;
        case 3:
          view.place_layer(any, at_origin({random.uniform(-1, 1), 0, 0}));
          break;
        case 4:
          view.show_layer(any, random.below(2) == 0);
          break;
        case 5:
          view.move_layer(any, random.below(std::uint32_t(count)));
          break;
        case 6:
          view.set_background(glm::vec3(random.uniform(0, 1)));
          break;
        case 7:
          if (count < 6) add("added", test::random_soup(any + seed, {.faces = 5}));
          break;
        default:
          if (count > 1) view.remove_layer(any);
      }
      const std::size_t now = view.history().position();
      if (now == view.history().steps().size() && (now > position || now + 1 > states.size())) {
        states.resize(now);  // a new step, or the last one again
        states.push_back(view.document());
      }
      ASSERT_TRUE(same(view.document(), states.at(now))) << "after " << i;
    }
    ASSERT_GT(view.history().steps().size(), 50u);
    EXPECT_EQ(image().pixels, expected().pixels);
    go_to(0);
    EXPECT_TRUE(same(view.document(), states[0]));
    EXPECT_EQ(image().pixels, before.pixels);
    go_to(view.history().steps().size());
    EXPECT_TRUE(same(view.document(), states.back()));
    EXPECT_EQ(image().pixels, expected().pixels);
  }
}

TEST_F(PageViews, ADragIsOneStepAndAMovedViewIsNone) {
  view.hold(true);
  for (int i = 1; i <= 10; ++i) view.place_layer(id(0), at_origin({0.1 * i, 0, 0}));
  view.hold(false);
  view.place_layer(id(0), at_origin({2, 0, 0}));
  view.controls().orbit(10, 5);
  view.controls().frame();
  view.show_layer(id(1), true);  // as it is
  view.move_layer(id(1), 1);
  EXPECT_THAT(steps(), ElementsAre("Move soup", "Move soup"));
  view.place_layer(id(0), at_origin({2, 0, 0}), false);  // only the visibility changes
  view.place_layer(id(0), at_origin({3, 0, 0}), true);
  EXPECT_THAT(steps(), ElementsAre("Move soup", "Move soup", "Hide soup", "Place soup"));
  view.set_up({0, 0, 1});
  view.controls().orbit(10, 5);
  EXPECT_EQ(steps().back(), "Change the up axis");
  undo();
  EXPECT_EQ(view.controls().up(), view.document().up);
  EXPECT_NE(view.controls().up(), glm::dvec3(0, 0, 1));
}

TEST_F(PageViews, AddedLayersAreOneStepAfterAllAreUploaded) {
  const Document before = view.document();
  const std::size_t bytes = view.renderer()->device_bytes();
  const Image8 without = image();
  const Primitives soup = test::random_soup(9, {}),
                   splats = test::random_splats(test::splat_kinds[1], 20, 0.2, 3);
  view.upload(prepared(soup), "soup 2");
  view.upload(prepared(splats), "splats 2");
  EXPECT_TRUE(same(view.document(), before));
  EXPECT_EQ(image().pixels, without.pixels) << "hidden until their step";
  view.drop_uploaded();
  EXPECT_EQ(view.renderer()->device_bytes(), bytes) << "cancelled";
  view.upload(prepared(soup), "soup 2");
  view.remove_layer(id(2));  // meanwhile
  view.upload(prepared(splats), "splats 2");
  const std::vector<LayerId> added = view.add_uploaded(true);
  ASSERT_EQ(added.size(), 2u);
  sources[added[0]] = &soup;
  sources[added[1]] = &splats;
  EXPECT_THAT(steps(), ElementsAre("Remove mesh", "Add 2 layers"));
  EXPECT_EQ(image().pixels, expected().pixels);
  EXPECT_THAT(undo(), IsEmpty());
  EXPECT_THAT(go_to(2), ElementsAre(added[0], added[1]));
  EXPECT_EQ(image().pixels, expected().pixels);
}

TEST_F(PageViews, KeepDocumentHistoryAndViewWhenTheDeviceIsLost) {
  view.place_layer(id(0), at_origin({0.2, 0, 0}));
  view.remove_layer(id(2));
  view.move_layer(id(1), 0);
  view.set_background({0.2f, 0.4f, 0.6f});
  view.controls().orbit(30, 10);
  view.controls().arrive();
  const Image8 before = image();
  const std::vector<LayerId> shown{id(0), id(1)};
  view.lose_device();
  EXPECT_FALSE(view.shows_scene());
  EXPECT_EQ(view.renderer(), nullptr);
  EXPECT_EQ(view.missing(), shown);
  upload_again({shown[1], shown[0]});
  EXPECT_EQ(image().pixels, before.pixels);
  EXPECT_EQ(steps().size(), 4u);
  go_to(0);
  EXPECT_EQ(image().pixels, expected().pixels);
}

TEST_F(PageViews, SurviveLostFiles) {
  const LayerId soup = id(0), splats = id(1), mesh = id(2);
  add("new", test::random_soup(9, {}));
  view.remove_layer(soup);
  view.lose_device();
  upload_again({id(2)});
  view.give_up({splats, mesh});
  EXPECT_EQ(view.document().layers.size(), 1u);
  EXPECT_EQ(image().pixels, expected().pixels);
  go_to(1);
  EXPECT_EQ(view.document().layers.size(), 2u);
  view.lose_device();
  upload_again({id(1)});
  view.give_up({soup});
  EXPECT_THROW(view.go_to(0), UsageError) << "no layer would be left";
}

TEST_F(PageViews, PlayAPathUntilItsEndOrAnother) {
  // Quaternions and logarithms round in doubles.
  const auto differs = [&](const Camera& from) {
    return glm::distance(view.controls().camera(64, 48).eye(), from.eye()) > 1e-9;
  };
  Camera first = view.controls().camera(64, 48), last = first;
  last.view_from_world[3].z -= 1;
  view.play(CameraPath({.keyframes = {{first, 1}, {last, 3}}}));
  EXPECT_EQ(view.draw(64, 48, 0), PageView::Next::moving);
  EXPECT_FALSE(differs(first));
  EXPECT_EQ(view.draw(64, 48, 1), PageView::Next::moving);
  EXPECT_TRUE(differs(first));
  EXPECT_EQ(view.draw(64, 48, 1.5), PageView::Next::nothing);
  EXPECT_FALSE(differs(last));
  EXPECT_TRUE(view.history().steps().empty());
  // A loop ends only when it is replaced.
  view.play(CameraPath(turntable({.first = first, .distance = 2, .seconds = 1})));
  EXPECT_EQ(view.draw(64, 48, 7.25), PageView::Next::moving);
  EXPECT_TRUE(differs(first));
  view.play({});
  EXPECT_EQ(view.draw(64, 48, 1), PageView::Next::nothing);
}

TEST_F(PageViews, DebugViewsFollow) {
  PageView::ReadScene read;
  for (const auto& [layer, primitives] : sources) read.layers[layer] = primitives;
  view.keep_read_scene(std::move(read));
  view.show(DebugView::depth, {});
  const Image8 before = image();
  const LayerId soup = id(0);
  view.move_layer(soup, 2);
  view.remove_layer(soup);
  EXPECT_NE(image().pixels, before.pixels);
  EXPECT_THROW(view.upload_again(prepared(*sources.at(soup)), soup), UsageError);
  view.show(DebugView::color, {});
  go_to(0);
  view.show(DebugView::depth, {});
  EXPECT_EQ(image().pixels, before.pixels);
}

}  // namespace page_view_test
}  // namespace tureen::web
