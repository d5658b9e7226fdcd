#include "formats/scene_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>

#include "formats/common/format_remarks.hpp"
#include "tests/formats/format_testing.hpp"

namespace tureen {
namespace scene_file_test {

using namespace test;
using ::testing::Contains;
using ::testing::Not;

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

const std::string off_text = "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

TEST(SceneFile, TellsFormatsByContentBeforeName) {
  const TemporaryFolder folder;
  write_text(folder / "a.off", off_text);
  write_text(folder / "b.ply", off_text);
  write_text(folder / "c", off_text);
  const Remark misnaming{&remarks::content_misnamed, {{"extension", ".ply"}, {"format", "OFF"}}};
  EXPECT_THAT(read_scene(folder / "a.off").info.remarks, Not(Contains(misnaming)));
  const Scene misnamed = read_scene(folder / "b.ply");
  EXPECT_EQ(only_soup(misnamed).triangles.size(), 1u);
  EXPECT_THAT(misnamed.info.remarks, Contains(misnaming));
  EXPECT_EQ(only_soup(read_scene(folder / "c")).triangles.size(), 1u);
}

TEST(SceneFile, AsksTheNameWhereTheContentSaysNothing) {
  const TemporaryFolder folder;
  write_text(folder / "a.OFF", "# a comment and nothing else\n");
  EXPECT_THAT(error_of([&] { read_scene(folder / "a.OFF"); }), ErrorAt("a.OFF:2"));
}

/// An empty image would not show whether the file or the view is wrong.
TEST(SceneFile, RefusesFilesWithoutTrianglesAlikeInEveryFormat) {
  const TemporaryFolder folder;
  write_text(folder / "a.off", "OFF\n1 0 0\n0 0 0\n");
  write_text(folder / "a.ply",
             "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
             "property float z\nelement face 0\nproperty list uchar int vertex_indices\n"
             "end_header\n");
  write_text(folder / "a.gltf",
             R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                 "nodes": [{}]})");
  TriangleSoup soup;
  soup.appearance = FaceColors{};
  write_scene(scene_of(soup), folder / "ours.glb");
  for (const char* name : {"a.off", "a.ply", "a.gltf", "ours.glb"})
    EXPECT_THAT(error_of([&] { read_scene(folder / name); }), ErrorAt(name));
}

TEST(SceneFile, ListsWhatIsReadWhereNothingFits) {
  const TemporaryFolder folder;
  write_text(folder / "a.txt", "hello");
  const auto message = error_of([&] { read_scene(folder / "a.txt"); });
  EXPECT_THAT(message, ErrorAt("a.txt"));
  for (const FormatInfo& format : known_formats()) {
    if (format.can_read) {
      EXPECT_THAT(message, ErrorAt("a.txt", format.name));
    }
  }
  EXPECT_THAT(error_of([&] { read_scene(folder / ""); }), ErrorAt(""));
  EXPECT_THAT(error_of([&] { read_scene(folder / "nothing"); }), ErrorAt("nothing"));
}

TEST(SceneFile, SaysWhatAFileIsThatIsNoScene) {
  const TemporaryFolder folder;
  const auto refusal = [&](const char* name, const char* content) {
    write_text(folder / name, content);
    return error_of([&] { read_scene(folder / name); });
  };
  for (const char* name : {"stray.glb", "stray.off", "stray.ply", "stray.pt", "stray.txt"}) {
    EXPECT_THAT(refusal(name, ""), ErrorAt(name));
    EXPECT_THAT(refusal(name, "\n <!DOCTYPE HTML><title>404</title>"), ErrorAt(name));
    EXPECT_THAT(refusal(name, "version https://git-lfs.github.com/spec/v1\n"),
                ErrorAt(name, "git lfs pull"));
    EXPECT_THAT(refusal(name, "\x89PNG\r\n\x1A\n"), ErrorAt(name));
    EXPECT_THAT(refusal(name, "\x1F\x8B\x08"), ErrorAt(name, "gunzip"));
  }
  EXPECT_THAT(refusal("noise.glb", "noise"), ErrorAt("noise.glb@0"));
}

TEST(SceneFile, FindsMobileNerfByItsFolderAndByItsObj) {
  const std::string folder =
      std::string(TUREEN_SOURCE_DIR) + "/../shared/data/soups/mobilenerf_drums";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " does not exist";
  for (const char* name : {"", "/shape2.obj"})
    EXPECT_EQ(only_soup(read_scene(folder + name)).triangles.size(), 11026u) << name;
}

TEST(SceneFile, EveryFormatStandsInTheTableOnce) {
  std::set<std::string> names, extensions;
  for (const FormatInfo& format : known_formats()) {
    EXPECT_TRUE(names.insert(format.name).second) << format.name;
    for (const std::string& extension : format.read_extensions)
      EXPECT_TRUE(extensions.insert(extension).second) << extension;
  }
}

TEST(SceneFile, WritesByExtension) {
  const TemporaryFolder folder;
  write_text(folder / "a.off", off_text);
  const Scene scene = read_scene(folder / "a.off");
  for (const FormatInfo& format : known_formats()) {
    for (const std::string& extension : format.written_extensions) {
      const auto path = folder / ("b" + extension);
      if (error_of<UsageError>([&] { write_scene(scene, path); })) {
        // What holds no triangles holds ellipsoids or discs.
        Splats splats{.kernel = Gaussians{.centers = {glm::vec3(1, 2, 3)},
                                          .scales = {glm::vec3(0.5f)},
                                          .rotations = {glm::quat(1, 0, 0, 0)},
                                          .opacity = {0.5f},
                                          .flat = extension == ".npz"},
                      .color = {.coefficients = {glm::vec3(0)}},
                      .profile = *profile_named(extension == ".npz" ? "2dgs" : "3dgs")};
        write_scene(scene_of(splats), path);
        EXPECT_EQ(count(std::get<Splats>(read_scene(path).layers[0].primitives)), 1u) << extension;
      } else if (format.can_read) {
        EXPECT_EQ(only_soup(read_scene(path)).positions, only_soup(scene).positions) << extension;
      }
    }
  }
  write_scene(scene, folder / "b");
  const Scene exported = read_scene(folder / "b");
  EXPECT_TRUE(std::get<LatticeTexture>(only_soup(exported).appearance).mlp);
  EXPECT_EQ(only_soup(exported).triangles, only_soup(scene).triangles);
  EXPECT_THAT(error_of<UsageError>([&] { write_scene(scene, folder / "b.xyz"); }),
              ErrorAt("", ".xyz", ".off", ".coff"));
}

}  // namespace scene_file_test
}  // namespace tureen
