// The preset in a scene's file, as the program obeys it.
#include <gmock/gmock.h>

#include "cli/program_fixture.hpp"
#include "formats/scene_file.hpp"
#include "formats/tureen_glb.hpp"

namespace tureen::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class PresetProgram : public Program {
 protected:
  /// The example with a preset.
  void write_preset(const RenderPreset& preset) const {
    Scene scene = read_scene(std::filesystem::path(TUREEN_SOURCE_DIR) / "examples/soup.glb", {});
    scene.preset = preset;
    write_tureen_glb(scene, folder / "preset.glb");
  }
  std::vector<std::string> plan(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"render",    "preset.glb", "--size", "160x120",
                                          "--context", "osmesa",     "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    if (result.exit_code != 0) return {"", ""};
    return nlohmann::json::parse(result.out)["plan"].get<std::vector<std::string>>();
  }
};

TEST_F(PresetProgram, RenderObeysItUnlessToldOtherwise) {
  write_preset({.lattice_level = 1, .promised_psnr_db = 10.0});
  const auto obeyed = plan();
  EXPECT_THAT(obeyed[0], HasSubstr("the scene's preset is obeyed"));
  EXPECT_THAT(obeyed[0], HasSubstr("lattice level at most 1"));
  EXPECT_THAT(obeyed[2], HasSubstr("knob: no lattice above level 1"));
  for (const std::string& sentence : plan({"--preset", "faithful"}))
    EXPECT_THAT(sentence, Not(HasSubstr("preset")));
  EXPECT_THAT(plan({"--pipeline", "published"})[0], HasSubstr("not obeyed"));
  EXPECT_EQ(run({"render", "preset.glb", "--preset", "fast"}).exit_code, 2);
  EXPECT_THAT(run({"info", "preset.glb"}).err,
              HasSubstr("lattice level at most 1; 10.0 dB promised"));
}

TEST_F(PresetProgram, WhatTheCommandAsksForCountsMore) {
  write_preset({.lattice_level = 1, .promised_psnr_db = 10.0});
  const auto has = [](const std::vector<std::string>& sentences, const char* words) {
    for (const std::string& sentence : sentences)
      if (sentence.find(words) != std::string::npos) return true;
    return false;
  };
  const auto both = plan({"--supersample", "2"});
  EXPECT_TRUE(has(both, "no lattice above level 1"));
  EXPECT_TRUE(has(both, "mean of 2 x 2 samples"));
  const auto asked = plan({"--preset", "faithful", "--supersample", "2"});
  EXPECT_FALSE(has(asked, "no lattice above level 1"));
  EXPECT_TRUE(has(asked, "mean of 2 x 2 samples"));
}

TEST_F(PresetProgram, RenderFallsBackWhereItBreaksItsPromise) {
  write_preset({.lattice_level = 0, .promised_psnr_db = 99.0});
  const auto sentences = plan();
  EXPECT_THAT(sentences[0], HasSubstr("the scene's preset is not obeyed"));
  EXPECT_THAT(sentences[0], HasSubstr("99.0 dB promised"));
  for (const std::string& sentence : sentences) EXPECT_THAT(sentence, Not(HasSubstr("knob:")));
}

}  // namespace
}  // namespace tureen::test
