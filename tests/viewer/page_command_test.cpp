// The command that writes the scene as a web page.
#include "viewer/page_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tureen::viewer {
namespace page_command_test {

using testing::ElementsAre;

SceneSource source() {
  SceneSource result;
  const auto header = std::make_shared<const Scene>(scene_of(TriangleSoup()));
  for (const char* path : {"/scenes/a.glb", "/scenes/b.ply"})
    result.files.push_back({.path = path, .watch = {}, .header = header});
  result.document.layers = {{{}, 1, std::make_shared<const Primitives>(TriangleSoup())},
                            {{}, 2, std::make_shared<const Primitives>(Splats())}};
  result.origins = {{1, {0}}, {2, {1}}};
  result.scene = std::make_shared<const Scene>();
  result.subject.up = {0, 0, 1};
  return result;
}

TEST(PageCommand, NamesAllFilesAndThePage) {
  EXPECT_THAT(page_arguments(source(), {.up = {0, 0, 1}}, "/a.html"),
              ElementsAre("convert", "/scenes/a.glb", "/scenes/b.ply", "-o", "/a.html"));
}

TEST(PageCommand, HasWhatTheWindowShowsOtherwiseThanTheFiles) {
  DrawingChoice choice;
  choice.plan.splat_profile = profile_named("2dgs");
  choice.quality = Quality{.supersampling = 2};
  EXPECT_THAT(
      page_arguments(source(), {.choice = choice, .max_splats = 900, .up = {0, -1, 0}}, "/a.html"),
      ElementsAre("convert", "/scenes/a.glb", "/scenes/b.ply", "-o", "/a.html", "--up", "0,-1,0",
                  "--max-splats", "900", "--profile", "2dgs", "--supersample", "2"));
}

/// The profile that the user wants stays when another scene opens.
TEST(PageCommand, OfASoupHasNoOptionsForSplats) {
  SceneSource soup = source();
  soup.document.layers.pop_back();
  DrawingChoice choice;
  choice.plan.splat_profile = profile_named("2dgs");
  choice.quality = Quality{.splat_order = Quality::SplatOrder::exact};
  EXPECT_THAT(page_arguments(soup, {.choice = choice, .up = {0, 0, 1}}, "/a.html"),
              ElementsAre("convert", "/scenes/a.glb", "-o", "/a.html"));
}

TEST(PageCommand, HasTheViewAndThePlaces) {
  SceneSource moved = source();
  moved.document.layers[1].world_from_layer = at_origin({1, 2, 3});
  EXPECT_THAT(
      page_arguments(moved, {.up = {0, 0, 1}, .view = "v.json"}, "/a.html"),
      ElementsAre("convert", "/scenes/a.glb", "/scenes/b.ply", "-o", "/a.html", "--view", "v.json",
                  "--place", "scene 2=at:1,2,3/turn:0,0,0/scale:1/mirror:no/visible"));
}

TEST(PageCommand, HasTheWindowsLimitOfMemory) {
  EXPECT_THAT(page_arguments(source(), {.max_memory = 1000, .up = {0, 0, 1}}, "/a.html"),
              ElementsAre("convert", "/scenes/a.glb", "/scenes/b.ply", "-o", "/a.html",
                          "--max-memory", "1000"));
}

}  // namespace page_command_test
}  // namespace tureen::viewer
