// The command that writes the scene as a web page.
#include "viewer/page_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tureen::viewer {
namespace page_command_test {

using testing::ElementsAre;

StageSource source() {
  StageSource result;
  for (const char* path : {"/scenes/a.glb", "/scenes/b.ply"})
    result.files.push_back({.path = path, .watch = {}, .header = nullptr});
  result.layers = {{.file = 0}, {.file = 1}};
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

}  // namespace page_command_test
}  // namespace tureen::viewer
