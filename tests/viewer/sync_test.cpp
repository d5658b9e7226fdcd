// The device follows the document, and uploads only what it lacks.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/gl/context.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/random_splats.hpp"
#include "viewer/scene/stage.hpp"

namespace tureen::viewer {
namespace sync_test {

using testing::ElementsAre;
using testing::IsEmpty;

/// A soup, splats and a mesh with textures, in a document without files.
struct Syncing : testing::Test {
  Syncing() {
    source.files.emplace_back();
    source.scene = std::make_shared<const Scene>();
    add("soup", test::random_soup(1, {.kind = test::Kind::lattice}));
    add("splats", test::random_splats(test::splat_kinds[1], 50, 0.1, 2));
    add("mesh", test::random_soup(3, {.kind = test::Kind::uv_textures}));
    stage = prepare_stage(source, request);
  }
  void add(const std::string& name, Primitives primitives) {
    DocumentLayer& layer = source.document.layers.emplace_back();
    layer.id = source.document.new_id();
    layer.name = name;
    layer.primitives = std::make_shared<const Primitives>(std::move(primitives));
  }
  void perform(const Edit& edit) { history.perform(source.document, edit); }
  LayerId id(std::size_t layer) const { return source.document.layers[layer].id; }
  /// The names of the layers that are uploaded.
  std::vector<std::string> follow() {
    std::vector<std::string> names;
    const std::vector<DocumentLayer> missing = sync(*stage, source.document);
    for (const DocumentLayer& layer : missing) names.push_back(layer.name);
    add_to(*stage, prepare_addition(missing, *source.scene, request));
    EXPECT_THAT(sync(*stage, source.document), IsEmpty());
    return names;
  }
  Image8 image(Stage& of) const {
    of.renderer.draw({test::camera_of_ball(4, 64, 48)});
    return of.renderer.read_color();
  }
  /// The image is that of the document prepared anew.
  void expect_image_of_document() {
    const auto anew = prepare_stage(source, request);
    EXPECT_EQ(image(*stage).pixels, image(*anew).pixels);
  }

  gl::Context context = gl::Context::create(test::osmesa);
  StageRequest request{context, {}, [](double) {}};
  SceneSource source;
  History history;
  std::unique_ptr<Stage> stage;
};

TEST_F(Syncing, UploadsOnlyWhatTheDeviceLacks) {
  const std::size_t bytes = stage->renderer.device_bytes();
  EXPECT_THAT(follow(), IsEmpty());
  perform(PlaceLayer{id(0), at_origin({0.2, 0, 0})});
  EXPECT_THAT(follow(), IsEmpty()) << "moved";
  perform(ShowLayer{id(1), false});
  EXPECT_THAT(follow(), IsEmpty()) << "hidden";
  perform(RenameLayer{id(1), "haze"});
  EXPECT_THAT(follow(), IsEmpty()) << "renamed";
  perform(ReorderLayer{id(2), 0});
  EXPECT_THAT(follow(), IsEmpty()) << "reordered";
  EXPECT_EQ(stage->renderer.device_bytes(), bytes);
  expect_image_of_document();
  perform(RemoveLayers{{id(1)}});
  EXPECT_THAT(follow(), IsEmpty()) << "removed";
  EXPECT_LT(stage->renderer.device_bytes(), bytes);
  history.undo(source.document);
  EXPECT_THAT(follow(), ElementsAre("soup")) << "restored";
  EXPECT_EQ(stage->renderer.device_bytes(), bytes);
  history.go_to(source.document, 0);
  EXPECT_THAT(follow(), IsEmpty()) << "undone";
  expect_image_of_document();
}

TEST_F(Syncing, PrimitivesThatWereReadAgainAreUploaded) {
  DocumentLayer& soup = source.document.layers[0];
  soup.primitives =
      std::make_shared<const Primitives>(test::random_soup(8, {.kind = test::Kind::lattice}));
  EXPECT_THAT(follow(), ElementsAre("soup"));
  expect_image_of_document();
}

TEST_F(Syncing, ALayerReplacesAllOthers) {
  AddLayers edit;
  add("new", test::random_soup(9, {}));
  edit.layers.push_back({3, source.document.layers.back()});
  source.document.layers.pop_back();
  perform(edit);
  perform(RemoveLayers{{id(0), id(1), id(2)}});
  EXPECT_THAT(follow(), ElementsAre("new"));
  expect_image_of_document();
}

TEST_F(Syncing, RandomEditsUndosAndRedosEndEqual) {
  constexpr std::uint64_t seed = 1;
  SCOPED_TRACE("seed " + std::to_string(seed));
  test::Random random(seed);
  const Image8 before = image(*stage);
  for (int i = 0; i < 300; ++i) {
    const std::size_t count = source.document.layers.size();
    const LayerId any = id(random.below(std::uint32_t(count)));
    switch (random.below(6)) {
      case 0:
        history.undo(source.document);
        break;
      case 1:
        history.redo(source.document);
        break;
      case 2:
        perform(PlaceLayer{any, at_origin({random.uniform(-1, 1), 0, 0})});
        break;
      case 3:
        perform(ShowLayer{any, random.below(2) == 0});
        break;
      case 4:
        perform(ReorderLayer{any, random.below(3)});
        break;
      default:
        if (count > 1) perform(RemoveLayers{{any}});
    }
    follow();
  }
  expect_image_of_document();
  history.go_to(source.document, 0);
  follow();
  EXPECT_EQ(image(*stage).pixels, before.pixels);
  history.go_to(source.document, history.steps().size());
  follow();
  expect_image_of_document();
}

}  // namespace sync_test
}  // namespace tureen::viewer
