// Documents, edits and their history.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/document/history.hpp"
#include "scene/similarity.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen::test {
namespace document_test {

using testing::ElementsAre;

bool operator==(const Bounds& a, const Bounds& b) { return a.low == b.low && a.high == b.high; }

/// What a user sees of the documents.
bool same(const Document& a, const Document& b) {
  return a.up == b.up && a.quality == b.quality && a.profile == b.profile &&
         a.background == b.background && a.first_view == b.first_view &&
         std::equal(a.layers.begin(), a.layers.end(), b.layers.begin(), b.layers.end(),
                    [](const DocumentLayer& x, const DocumentLayer& y) {
                      return x.id == y.id && x.primitives == y.primitives && x.name == y.name &&
                             x.visible == y.visible && x.bounds == y.bounds &&
                             x.world_from_layer == y.world_from_layer && x.material == y.material;
                    });
}

DocumentLayer layer(Document& document, const std::string& name, Primitives primitives) {
  DocumentLayer result;
  result.id = document.new_id();
  result.name = name;
  result.primitives = std::make_shared<const Primitives>(std::move(primitives));
  return result;
}

/// A soup, splats and a mesh with textures.
Document three_layers() {
  Document document;
  document.layers.push_back(layer(document, "soup", random_soup(1, {.kind = Kind::lattice})));
  document.layers.push_back(layer(document, "splats", random_splats(splat_kinds[1], 50, 0.1, 2)));
  document.layers.push_back(layer(document, "mesh", random_soup(3, {.kind = Kind::uv_textures})));
  return document;
}

std::vector<std::string> names(const Document& document) {
  std::vector<std::string> result;
  for (const DocumentLayer& each : document.layers) result.push_back(each.name);
  return result;
}

std::vector<std::string> names(const History& history) {
  std::vector<std::string> result;
  for (const History::Step& each : history.steps()) result.push_back(each.name);
  return result;
}

glm::dmat4 moved(double x) { return at_origin({x, 0, 0}); }

/// Any edit of the document.
Edit random_edit(Document& document, Random& random) {
  const auto below = [&](std::size_t count) {
    return std::size_t(random.below(std::uint32_t(count)));
  };
  const LayerId id =
      document.layers.empty() ? 0 : document.layers[below(document.layers.size())].id;
  switch (below(12)) {
    case 0: {
      AddLayers add;
      for (std::size_t i = 0; i < 1 + below(2); ++i)
        add.layers.push_back({below(document.layers.size() + 1) + 2 * i,
                              layer(document, "added", random_soup(id + i, {.faces = 5}))});
      return add;
    }
    case 1:
      return RemoveLayers{{id, document.layers.empty() ? 0 : document.layers[0].id}};
    case 2:
      return PlaceLayer{id, moved(random.uniform(-1, 1)),
                        below(2) == 0 ? std::nullopt : std::optional(below(2) == 0)};
    case 3:
      return RenameLayer{id, "name " + std::to_string(below(100))};
    case 4:
      return ShowLayer{id, below(2) == 0};
    case 5:
      return ReorderLayer{id, below(5)};
    case 6:
      return ChangeUp{glm::dvec3(0, 0, below(2) == 0 ? 1 : -1)};
    case 7:
      return ChangeQuality{{.supersampling = 1 + int(below(8))}};
    case 8:
      return ChangeBackground{glm::vec3(random.uniform(0, 1))};
    case 10: {
      Camera view;
      view.width = int(below(100));
      return ChangeFirstView{view};
    }
    case 9:
      return SetMaterial{id, below(3) == 0   ? std::nullopt
                             : below(2) == 0 ? std::optional(mirror_material())
                                             : glass_material(1 + random.uniform(0, 1))};
    default:
      return ChangeProfile{profile_named(below(2) == 0 ? "3dgs" : "mip")};
  }
}

TEST(Documents, RandomEditsUndosAndRedosEndEqual) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    Document document = three_layers();
    History history;
    std::vector<Document> states{document};  // at each position of the history
    for (int i = 0; i < 300; ++i) {
      const std::uint32_t what = random.below(4);
      if (what == 0) {
        history.undo(document);
      } else if (what == 1) {
        history.redo(document);
      } else {
        const Edit edit = random_edit(document, random);
        states.resize(history.position() + 1);
        history.perform(document, edit);
        states.push_back(document);
      }
      ASSERT_TRUE(same(document, states[history.position()])) << "after " << i;
    }
    history.go_to(document, 0);
    EXPECT_TRUE(same(document, three_layers()) || same(document, states[0]));
    history.go_to(document, history.steps().size());
    EXPECT_TRUE(same(document, states.back()));
  }
}

TEST(Documents, EditsOfLayersThatTheDocumentLacksChangeNothing) {
  Document document = three_layers();
  const Document before = document;
  for (const Edit& edit : {Edit(RemoveLayers{{99}}), Edit(PlaceLayer{99, moved(1)}),
                           Edit(RenameLayer{99, "x"}), Edit(ShowLayer{99, false}),
                           Edit(ReorderLayer{99, 0}), Edit(SetMaterial{99, mirror_material()})})
    apply_edit(document, apply_edit(document, edit));
  EXPECT_TRUE(same(document, before));
}

TEST(Histories, StepsOfPlacesAreNamedByWhatChanges) {
  Document document = three_layers();
  History history;
  const LayerId soup = document.layers[0].id;
  Similarity place{.position = {1, 2, 3}};
  history.perform(document, PlaceLayer{soup, matrix_of(place)});
  place.angles.y = 30;
  history.perform(document, PlaceLayer{soup, matrix_of(place)});
  place.scale = 2.5;
  history.perform(document, PlaceLayer{soup, matrix_of(place)});
  place.position.x = 0;
  place.scale = 1;
  history.perform(document, PlaceLayer{soup, matrix_of(place)});
  EXPECT_THAT(names(history), ElementsAre("Move soup", "Turn soup", "Scale soup", "Place soup"));
}

TEST(Histories, StepsHaveNames) {
  Document document = three_layers();
  History history;
  const LayerId soup = document.layers[0].id, mesh = document.layers[2].id;
  history.perform(document, PlaceLayer{soup, moved(1)});
  history.perform(document, ShowLayer{mesh, false});
  history.perform(document, ReorderLayer{mesh, 0});
  history.perform(document, SetMaterial{mesh, mirror_material()});
  history.perform(document, RemoveLayers{{soup}});
  history.perform(document, ChangeUp{{0, 0, 1}});
  EXPECT_THAT(names(history),
              ElementsAre("Move soup", "Hide mesh", "Reorder mesh", "Change the surface of mesh",
                          "Remove soup", "Change the up axis"));
  EXPECT_THAT(names(document), ElementsAre("mesh", "splats"));
  history.undo(document);
  history.undo(document);
  EXPECT_THAT(names(document), ElementsAre("mesh", "soup", "splats"));
}

TEST(Histories, AGestureIsOneStep) {
  Document document = three_layers();
  const Document before = document;
  History history;
  const LayerId soup = document.layers[0].id, mesh = document.layers[2].id;
  for (int i = 1; i <= 10; ++i) history.perform(document, PlaceLayer{soup, moved(i)}, 7);
  history.perform(document, PlaceLayer{mesh, moved(1)}, 7);  // another layer
  history.perform(document, PlaceLayer{mesh, moved(2)}, 8);  // another gesture
  history.perform(document, PlaceLayer{mesh, moved(3)});
  history.perform(document, PlaceLayer{mesh, moved(4)});
  EXPECT_EQ(history.steps().size(), 5u);
  history.go_to(document, 1);
  EXPECT_EQ(document.layers[0].world_from_layer, moved(10));
  history.undo(document);
  EXPECT_TRUE(same(document, before));
}

TEST(Histories, APlaceAndAVisibilityAreOneStep) {
  Document document = three_layers();
  const Document before = document;
  History history;
  const LayerId soup = document.layers[0].id;
  history.perform(document, PlaceLayer{soup, moved(1)}, 7);
  history.perform(document, PlaceLayer{soup, moved(2), false}, 7);  // sets more: another step
  history.perform(document, PlaceLayer{soup, moved(3), false}, 7);
  EXPECT_FALSE(document.layers[0].visible);
  ASSERT_EQ(history.steps().size(), 2u);
  EXPECT_EQ(history.steps()[1].name, "Place " + document.layers[0].name);
  history.undo(document);
  EXPECT_TRUE(document.layers[0].visible);
  EXPECT_EQ(document.layers[0].world_from_layer, moved(1));
  history.undo(document);
  EXPECT_TRUE(same(document, before));
}

TEST(Histories, AnIndexThatIsDraggedIsOneStep) {
  Document document = three_layers();
  History history;
  const LayerId mesh = document.layers[2].id;
  history.perform(document, SetMaterial{mesh, mirror_material()});
  for (int i = 1; i <= 10; ++i)
    history.perform(document, SetMaterial{mesh, glass_material(1 + 0.1f * float(i))}, 7);
  EXPECT_EQ(history.steps().size(), 2u);
  EXPECT_EQ(document.layers[2].material, glass_material(2));
  history.undo(document);
  EXPECT_EQ(document.layers[2].material, mirror_material());
  history.undo(document);
  EXPECT_EQ(document.layers[2].material, std::nullopt);
}

TEST(Histories, KnowWhatIsSaved) {
  Document document = three_layers();
  History history;
  const LayerId soup = document.layers[0].id;
  EXPECT_TRUE(history.is_saved());
  history.perform(document, PlaceLayer{soup, moved(1)}, 1);
  EXPECT_FALSE(history.is_saved());
  history.mark_saved(history.state());
  EXPECT_TRUE(history.is_saved());
  history.perform(document, PlaceLayer{soup, moved(2)}, 1);  // the same drag
  EXPECT_FALSE(history.is_saved());
  history.mark_saved(history.state());
  history.undo(document);
  EXPECT_FALSE(history.is_saved());
  history.redo(document);
  EXPECT_TRUE(history.is_saved());
  history.undo(document);
  history.perform(document, PlaceLayer{soup, moved(3)});  // the saved state is gone
  EXPECT_FALSE(history.is_saved());
  history.undo(document);
  EXPECT_FALSE(history.is_saved());
}

TEST(Histories, DropTheOldestStepsBeyondTheirMemory) {
  Document document = three_layers();
  const std::size_t bytes = byte_size(std::get<Splats>(*document.layers[1].primitives));
  History history(bytes);
  const LayerId splats = document.layers[1].id;
  history.perform(document, PlaceLayer{splats, moved(1)});
  history.perform(document, RemoveLayers{{splats}});
  EXPECT_EQ(history.kept_bytes(), bytes);
  AddLayers add;
  add.layers.push_back({0, layer(document, "big", random_splats(splat_kinds[1], 60, 0.1, 4))});
  history.perform(document, add);
  history.perform(document, ChangeUp{{0, 0, 1}});
  EXPECT_THAT(names(history),
              ElementsAre("Move splats", "Remove splats", "Add big", "Change the up axis"));
  // The removed splats are the oldest.
  history.perform(document, RemoveLayers{{document.layers[0].id}});
  EXPECT_LE(history.kept_bytes(), bytes);
  EXPECT_TRUE(history.steps().empty()) << "the last step alone is beyond the memory";
  EXPECT_FALSE(history.is_saved());
  history.undo(document);
  EXPECT_THAT(names(document), ElementsAre("soup", "mesh"));
}

TEST(Histories, StepsWithoutPrimitivesSurviveTheLimit) {
  Document document = three_layers();
  History history(0);
  const LayerId soup = document.layers[0].id, mesh = document.layers[2].id;
  history.perform(document, RemoveLayers{{soup}});
  history.perform(document, PlaceLayer{mesh, moved(1)});
  history.perform(document, PlaceLayer{mesh, moved(2)});
  EXPECT_THAT(names(history), ElementsAre("Move mesh", "Move mesh"));
  AddLayers add;
  add.layers.push_back({9, layer(document, "new", random_soup(9, {}))});
  history.perform(document, add);
  history.undo(document);  // now only the history keeps the layer
  EXPECT_THAT(names(history), ElementsAre("Move mesh", "Move mesh"));
  history.go_to(document, 0);
  EXPECT_EQ(document.layers.back().world_from_layer, moved(0));
}

TEST(Histories, ReadingAgainReplacesPrimitivesInTheirSteps) {
  Document document = three_layers();
  History history;
  DocumentLayer read = document.layers[0];
  history.perform(document, RemoveLayers{{read.id}});
  read.primitives = std::make_shared<const Primitives>(random_soup(8, {}));
  history.replace_primitives(read);
  EXPECT_EQ(history.steps().size(), 1u);
  history.undo(document);
  EXPECT_EQ(document.layers[0].primitives, read.primitives);
}

}  // namespace document_test
}  // namespace tureen::test
