// The command line that draws the window's image: parsed by a shell and by `tureen render`, it
// results in the same camera.
#include "viewer/render_command.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <sstream>

#include "camera/camera_controls.hpp"

namespace tureen::viewer {
namespace render_command_test {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// The words of a line, split by a POSIX shell.
std::vector<std::string> words_of(const std::string& line) {
  std::FILE* shell =
      popen(("for word in " + line + "; do printf '%s\\n' \"$word\"; done").c_str(), "r");
  std::string text;
  for (int letter = 0; (letter = std::fgetc(shell)) != EOF;) text += char(letter);
  pclose(shell);
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word);) words.push_back(word);
  return words;
}

glm::dvec3 vector_after(const std::vector<std::string>& words, const std::string& option) {
  const auto at = std::find(words.begin(), words.end(), option);
  glm::dvec3 v(0.0);
  EXPECT_NE(at, words.end());
  EXPECT_EQ(std::sscanf(at[1].c_str(), "%lf,%lf,%lf", &v.x, &v.y, &v.z), 3) << at[1];
  return v;
}

const auto header = std::make_shared<const Scene>(scene_of(TriangleSoup()));

SceneSource source(const std::string& path) {
  SceneSource result;
  result.files.push_back({.path = path, .watch = {}, .header = header});
  result.document.layers = {{{}, 1, std::make_shared<const Primitives>(Splats())}};
  result.origins = {{1, {0}}};
  result.scene = std::make_shared<const Scene>();
  return result;
}

TEST(RenderCommand, NamesAllFilesWithLayers) {
  SceneSource scene = source("a.glb");
  for (const char* path : {"removed.glb", "b c.glb"})
    scene.files.push_back({.path = path, .watch = {}, .header = header});
  scene.document.layers = {{{}, 1}, {{}, 2}};
  scene.origins = {{1, {0}}, {2, {2}}};
  const Camera camera = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.8, 400, 300);
  EXPECT_THAT(render_command(scene, {}, {}, camera, ""),
              testing::StartsWith("tureen render a.glb 'b c.glb' --eye"));
}

TEST(RenderCommand, NamesTheSameCamera) {
  CameraControls controls({.low = {100, -2, 3}, .high = {104, 5, 9}, .up = {0, 0, 1}});
  controls.set_smoothing(0);
  controls.orbit(37, -12);
  controls.pan(5, 7);
  controls.set_fov(0.7);
  const Camera camera = controls.camera(801, 633);
  ASSERT_FALSE(needs_camera_file(camera));
  const auto words = words_of(render_command(source("it's a soup.glb"), {}, {}, camera, ""));
  ASSERT_GE(words.size(), 3u);
  EXPECT_EQ(words[2], "it's a soup.glb") << "quoted for the shell";
  double fov = 0;
  const auto at = std::find(words.begin(), words.end(), "--fov");
  ASSERT_EQ(std::sscanf(at[1].c_str(), "%lf", &fov), 1);
  const Camera read = look_at(vector_after(words, "--eye"), vector_after(words, "--target"),
                              vector_after(words, "--up"), fov / 57.295779513082320877, 801, 633);
  // Only rounding: far below the 1/256 pixel that vertices snap to.
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      EXPECT_NEAR(read.view_from_world[column][row], camera.view_from_world[column][row], 1e-11);
  EXPECT_NEAR(read.fy, camera.fy, 1e-9);
  EXPECT_NEAR(read.cx, camera.cx, 1e-9);
}

TEST(RenderCommand, WhatOptionsCannotSayComesFromAFile) {
  Camera camera = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.8, 400, 300);
  camera.cx += 3;
  ASSERT_TRUE(needs_camera_file(camera));
  const std::string command = render_command(source("a.glb"), {}, {}, camera, "a-1.camera.json");
  EXPECT_THAT(command, HasSubstr("--camera a-1.camera.json"));
  EXPECT_THAT(command, Not(HasSubstr("--eye")));
}

TEST(RenderCommand, NamesTheDebugView) {
  const Camera camera = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.8, 400, 300);
  const auto command = [&](const DebugViewChoice& debug_view) {
    return render_command(source("a.glb"), {}, debug_view, camera, "");
  };
  EXPECT_THAT(command({}), Not(HasSubstr("--debug-view")));
  EXPECT_THAT(command({DebugView::triangle_id, {}}), HasSubstr("--debug-view triangle-id "));
  EXPECT_THAT(command({DebugView::features, {4, 3}}), HasSubstr("--debug-view features:4-6 "));
  EXPECT_THAT(command({DebugView::features, {3, 1}}), HasSubstr("--debug-view features:3 "));
}

TEST(RenderCommand, SaysHowItIsDrawn) {
  const Camera camera = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.8, 400, 300);
  DrawingChoice choice;
  choice.quality = Quality{.supersampling = 3};
  choice.plan.specialisations = SpecialisationSet::all().without(Specialisation::alpha_test);
  const std::string command = render_command(source("a.glb"), choice, {}, camera, "");
  EXPECT_THAT(command, HasSubstr("--supersample 3"));
  EXPECT_THAT(command, HasSubstr("--keep alpha-test"));
  SceneSource fine = source("a.glb");
  Scene scene = *fine.scene;
  scene.quality.supersampling = 3;
  fine.scene = std::make_shared<const Scene>(scene);
  EXPECT_THAT(render_command(fine, choice, {}, camera, ""), Not(HasSubstr("--supersample")));
  choice.plan.splat_profile = profile_named("mip");
  choice.plan.as_published = true;
  choice.plan.splat_blending = SplatBlending::raster;
  choice.quality = Quality{};
  EXPECT_THAT(render_command(fine, choice, {}, camera, ""),
              AllOf(HasSubstr("--as-published --blend raster"),
                    HasSubstr("--profile mip --supersample 1")));
  fine.document.layers = {{{}, 1, std::make_shared<const Primitives>(TriangleSoup())}};
  EXPECT_THAT(render_command(fine, choice, {}, camera, ""),
              AllOf(HasSubstr("--supersample 1"), Not(HasSubstr("--profile"))));
}

TEST(RenderCommand, OfRaysHasTheirOptionsAndSurfaces) {
  const Camera camera = look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 0.8, 400, 300);
  DrawingChoice choice;
  choice.pipeline = PipelineKind::baseline;
  choice.plan.specialise = false;
  choice.plan.splat_profile = profile_named("mip");
  choice.quality = Quality{.supersampling = 8};
  SceneSource splats = source("a.glb");
  const auto command = [&](const SceneSource& scene, int rays) {
    return render_command(scene, choice, {}, camera, "", {}, rays);
  };
  EXPECT_THAT(command(splats, 64),
              AllOf(HasSubstr("--renderer trace --profile mip --samples 64 "),
                    Not(HasSubstr("--pipeline")), Not(HasSubstr("--no-specialise"))));
  EXPECT_THAT(command(splats, 1), AllOf(HasSubstr("--renderer trace"), Not(HasSubstr("--samples")),
                                        Not(HasSubstr("--supersample"))));
  // --samples excludes a number of samples that the scene stores.
  Scene fine = *splats.scene;
  fine.quality.supersampling = 3;
  splats.scene = std::make_shared<const Scene>(fine);
  EXPECT_THAT(command(splats, 64), HasSubstr("--supersample 1 --samples 64"));

  Scene file;
  file.layers = {{.name = "floor"}, {.name = "the ball"}, {.name = "window"}};
  file.layers[2].material = glass_material(1.5f);
  SceneSource meshes = source("b.glb");
  meshes.files[0].header = std::make_shared<const Scene>(file);
  meshes.document.layers.clear();
  for (LayerId id = 1; id <= 3; ++id) {
    DocumentLayer layer;
    layer.id = id;
    layer.primitives = std::make_shared<const Primitives>(TriangleSoup());
    meshes.document.layers.push_back(layer);
    meshes.origins[id] = {0, std::size_t(id - 1), file.layers[std::size_t(id - 1)].name};
  }
  meshes.document.layers[0].material = mirror_material();
  meshes.document.layers[1].material = glass_material(1.25f);
  meshes.document.layers[2].material = glass_material(1.5f);
  const std::string surfaces = command(meshes, 4);
  EXPECT_THAT(surfaces, AllOf(HasSubstr("--material floor=mirror --material 'the ball=glass:1.25'"),
                              Not(HasSubstr("window"))));
  EXPECT_THAT(command(meshes, 0), Not(HasSubstr("--material")));
}

}  // namespace render_command_test
}  // namespace tureen::viewer
