// `tureen convert SCENE OUT.html`: the page contains the scene unchanged.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "formats/common/uri.hpp"
#include "formats/scene_file.hpp"
#include "tests/cli/program_fixture.hpp"
#include "tests/support/errors.hpp"

namespace tureen {
namespace scene_page_program_test {

using test::Names;
namespace fs = std::filesystem;
using test::Child;
using test::ChildResult;

constexpr const char* element =
    R"(<script type="application/octet-stream;base64" id="scene" data-name=""></script>)";

class ScenePage : public test::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    write("template.html",
          std::string("<!doctype html>\n<p>before</p>\n") + element + "\n<p>after");
    ::setenv("TUREEN_WEB_TEMPLATE", "template.html", 1);
  }
  void TearDown() override {
    ::unsetenv("TUREEN_WEB_TEMPLATE");
    Program::TearDown();
  }

  std::string text_of(const std::string& name) const {
    std::ifstream stream(folder / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  /// The scene in the page, as a string of bytes. Fails the test if the page around it differs from
  /// the template.
  std::string scene_in(const std::string& page, const std::string& escaped_name) const {
    const std::string text = text_of(page);
    const std::string before =
        "<!doctype html>\n<p>before</p>\n"
        R"(<script type="application/octet-stream;base64" id="scene" data-name=")" +
        escaped_name + "\">";
    const std::string after = "</script>\n<p>after";
    EXPECT_EQ(text.substr(0, before.size()), before);
    const std::size_t end = text.find('<', before.size());
    EXPECT_EQ(text.substr(std::min(end, text.size())), after);
    const auto bytes =
        decode_data_uri("data:;base64," + text.substr(before.size(), end - before.size()));
    return {reinterpret_cast<const char*>(bytes->data()), bytes->size()};
  }

  /// Writes a part of the example that compresses quickly, under a name that needs escaping.
  void write_part() const {
    Scene scene = read_scene(std::string(TUREEN_SOURCE_DIR) + "/examples/soup.glb");
    auto& soup = only_soup(scene);
    soup.triangles.resize(400);
    std::get<LatticeTexture>(soup.appearance).patches.resize(400);
    scene.cameras.resize(1);
    scene.cameras[0] = resized(scene.cameras[0], 160, 120);
    scene.info.name = R"(<a> & "b")";
    ASSERT_TRUE(tureen::write_scene(scene, folder / "part.glb").empty());
  }
};

class ThoroughScenePage : public ScenePage {};

constexpr const char* part_name = "&lt;a&gt; &amp; &quot;b&quot;";

TEST_F(ScenePage, HoldsAFileOfOursAsItIs) {
  write_part();
  const ChildResult result = run({"convert", "part.glb", "part.html", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(scene_in("part.html", part_name) == text_of("part.glb"));
  EXPECT_THAT(result.err, Names("part.html"));
  const auto json = nlohmann::ordered_json::parse(result.out);
  EXPECT_THAT(keys(json),
              testing::ElementsAre("output", "bytes_on_disk", "notes", "remarks", "lost"));
  EXPECT_EQ(json["output"], "part.html");
  EXPECT_EQ(json["bytes_on_disk"], fs::file_size(folder / "part.html"));
}

TEST_F(ScenePage, HoldsOtherScenesAsTheGlbThatConvertMakes) {
  write_scene();
  ASSERT_EQ(run({"convert", "scene.off", "scene.glb"}).exit_code, 0);
  const ChildResult result = run({"convert", "scene.off", "Scene.HTML"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(scene_in("Scene.HTML", "scene") == text_of("scene.glb"));
  EXPECT_FALSE(exists("Scene.HTML.glb"));
  // With --up, the program writes its own files anew.
  ASSERT_EQ(run({"convert", "scene.glb", "turned.glb", "--up", "1,0,0"}).exit_code, 0);
  ASSERT_EQ(run({"convert", "scene.glb", "turned.html", "--up", "1,0,0"}).exit_code, 0);
  EXPECT_TRUE(scene_in("turned.html", "scene") == text_of("turned.glb"));
  EXPECT_FALSE(text_of("turned.glb") == text_of("scene.glb"));
}

TEST_F(ThoroughScenePage, MayBeCompressed) {
  write_part();
  const std::vector<std::string> compressed{"--slim", "--max-error", "0.3"};
  const auto convert = [&](const std::string& in, const std::string& out, bool with_compressed) {
    std::vector<std::string> arguments{"convert", in, out};
    if (with_compressed) arguments.insert(arguments.end(), compressed.begin(), compressed.end());
    ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result;
  };
  convert("part.glb", "compressed.glb", true);
  EXPECT_THAT(convert("part.glb", "compressed.html", true).err, Names("--compress"));
  EXPECT_TRUE(scene_in("compressed.html", part_name) == text_of("compressed.glb"));
  EXPECT_FALSE(exists("compressed.html.glb"));
  // A compressed scene stays compressed.
  convert("compressed.glb", "again.html", false);
  EXPECT_TRUE(scene_in("again.html", part_name) == text_of("compressed.glb"));
}

TEST_F(ScenePage, SpansManyPiecesAndLengths) {
  // Scenes larger than the pieces that are written at a time. Their lengths modulo 3 are 0, 1 and
  // 2.
  std::set<std::size_t> remainders;
  for (const int faces : {4000, 4001, 4002, 4003, 4004, 4005}) {
    std::string off = "COFF\n3 " + std::to_string(faces) + " 0\n0 0 0\n1 0 0\n0 1 0\n";
    for (int t = 0; t < faces; ++t) off += "3 0 1 2 " + std::to_string(t % 256) + " 0 9\n";
    write("many.off", off);
    ASSERT_EQ(run({"convert", "many.off", "many.glb", "--force"}).exit_code, 0);
    ASSERT_EQ(run({"convert", "many.glb", "many.html", "--force"}).exit_code, 0);
    const std::string glb = text_of("many.glb");
    EXPECT_GT(glb.size(), 2u * 3 * 16384);
    remainders.insert(glb.size() % 3);
    EXPECT_TRUE(scene_in("many.html", "many") == glb);
  }
  EXPECT_EQ(remainders.size(), 3u);
}

TEST_F(ScenePage, NeverOverwritesSilently) {
  write_scene();
  write("page.html", "precious");
  const ChildResult refused = run({"convert", "scene.off", "page.html"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, Names("page.html", "--force"));
  EXPECT_EQ(text_of("page.html"), "precious");
  EXPECT_EQ(run({"convert", "scene.off", "page.html", "--force"}).exit_code, 0);
  EXPECT_NE(text_of("page.html"), "precious");

  write("other.html.glb", "precious");
  const ChildResult in_the_way = run({"convert", "scene.off", "other.html"});
  EXPECT_EQ(in_the_way.exit_code, 2);
  EXPECT_THAT(in_the_way.err, Names("other.html.glb"));
  EXPECT_EQ(text_of("other.html.glb"), "precious");
}

TEST_F(ScenePage, WantsATemplateWithOnePlaceBeforeTheSceneIsRead) {
  const auto expect = [&](int exit_code, const auto&... values) {
    const ChildResult result = run({"convert", "nowhere.off", "page.html"});
    EXPECT_EQ(result.exit_code, exit_code);
    EXPECT_THAT(result.err, Names(values...));
    EXPECT_FALSE(exists("page.html"));
  };
  expect(3, "nowhere.off");
  write("template.html", "<p>no place</p>");
  expect(3, "template.html", element);
  write("template.html", std::string(element) + element);
  expect(3, "template.html");
  ::setenv("TUREEN_WEB_TEMPLATE", "gone.html", 1);
  expect(3, "gone.html");
}

TEST_F(ScenePage, FindsTheTemplateNearTheProgram) {
  ::unsetenv("TUREEN_WEB_TEMPLATE");
  write_scene();
  const fs::path program = folder / "installed/bin/tureen";
  fs::create_directories(program.parent_path());
  fs::copy_file(TUREEN_PROGRAM, program);
  const auto convert = [&] {
    return Child({"convert", "scene.off", "page.html", "--force"}, folder, program.string()).wait();
  };
  const ChildResult none = convert();
  EXPECT_EQ(none.exit_code, 5);
  EXPECT_THAT(none.err, Names("share/tureen/scene_template.html", "./dev web"));
  EXPECT_FALSE(exists("page.html"));
  for (const char* place : {"installed/bin/share/tureen", "installed/share/tureen"}) {
    fs::create_directories(folder / place);
    write(std::string(place) + "/scene_template.html", std::string(place) + element);
    const ChildResult result = convert();
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(text_of("page.html"), testing::StartsWith(std::string(place) + "<script"))
        << "share/ beside bin/ takes precedence";
  }
}

TEST_F(ScenePage, IsInTheHelp) {
  const std::string help = run({"convert", "--help"}).out;
  EXPECT_THAT(help, Names(".html"));
  EXPECT_THAT(help, Names("tureen convert soup.glb soup.html"));
}

}  // namespace scene_page_program_test
}  // namespace tureen
