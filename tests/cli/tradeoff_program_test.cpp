// Program tests of `tureen tradeoff`, on a small random soup.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "formats/scene_file.hpp"
#include "scene/edit/lattice_refine.hpp"
#include "tests/cli/photographs_fixture.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/random_soups.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen {
namespace tradeoff_program_test {

using test::Child;
using test::ChildResult;
using test::Names;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class Tradeoff : public test::ProgramWithPhotographs {
 protected:
  void write_soup() const {
    tureen::write_scene(
        scene_of(test::random_soup(3, {.kind = test::Kind::lattice_mlp, .level = 2})),
        folder / "soup.glb");
  }
  /// The configuration in the antialiasing panel with these non-default settings; null if it was
  /// not measured.
  static nlohmann::json antialiased(const nlohmann::json& document,
                                    const std::map<std::string, std::string>& values) {
    const auto& all = document["antialiasing"]["configurations"];
    nlohmann::json settings = all[0]["knobs"];
    for (const auto& [key, value] : values) settings[key] = value;
    for (const auto& each : all)
      if (each["knobs"] == settings) return each;
    return nullptr;
  }
  std::string text_of(const std::string& name) const {
    std::ifstream stream(folder / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  ChildResult tradeoff(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"tradeoff", "soup.glb", "--quick", "--context", "osmesa"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

class ThoroughTradeoff : public Tradeoff {};

TEST_F(Tradeoff, MeasuresWritesAndKeepsTheChoice) {
  write_soup();
  const std::string stored = text_of("soup.glb");
  // The defaults certainly satisfy these limits, so that there is a choice.
  const ChildResult result = tradeoff({"--json", "-o", "report", "--write", "fast.glb",
                                       "--least-psnr", "20", "--most-mismatch", "0.2"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_TRUE(exists("report/tradeoff.json"));
  EXPECT_TRUE(exists("report/report.html"));
  for (const auto& path : json["output"]) EXPECT_TRUE(exists(path)) << path;

  const auto& configurations = json["drawing"]["configurations"];
  EXPECT_EQ(configurations[0]["name"], "defaults");
  // The defaults equal the oracle up to rounding to 8 bits: 58.9 dB if every pixel is covered.
  EXPECT_GT(configurations[0]["e_render"]["psnr_db"], 45);
  // The grid moves edges, which is an error of no setting.
  EXPECT_LT(configurations[0]["e_render_exact"]["psnr_db"],
            configurations[0]["e_render"]["psnr_db"]);
  EXPECT_GT(json["drawing"]["front"].size(), 0u);
  int generic = 0, coarse = 0;
  for (const auto& each : configurations) {
    generic += each["method"] == "tureen --no-specialise";
    coarse += each["knobs"]["lattice_level"] == "0";
  }
  EXPECT_GT(generic, 5);
  EXPECT_GT(coarse, 0);
  ASSERT_GT(json["antialiasing"]["configurations"].size(), 3u);
  // The reference has 8 x 8 samples a pixel: 2 x 2 samples are closer to it than one.
  const auto& smooth = json["antialiasing"]["configurations"];
  for (const auto& each : smooth) {
    if (each["knobs"]["supersampling"] == "2") {
      EXPECT_GT(each["e_render"]["psnr_db"], smooth[0]["e_render"]["psnr_db"].get<double>() + 1);
      EXPECT_GT(each["mib"], smooth[0]["mib"].get<double>()) << "larger targets";
    }
  }

  // Reduced resolution and supersampling cannot be combined.
  EXPECT_TRUE(antialiased(json, {{"resolution_scale", "0.5"}, {"supersampling", "2"}}).is_null());

  EXPECT_THAT(result.err, Names("fast.glb"));
  // The new file contains the reduced data, and the old file is unchanged.
  EXPECT_EQ(text_of("soup.glb"), stored);
  const Scene kept = read_scene(folder / "fast.glb");
  const auto& soup = only_soup(kept);
  const auto& texture = std::get<LatticeTexture>(soup.appearance);
  const auto& chosen = configurations[json["choice"]["configuration"].get<std::size_t>()]["knobs"];
  EXPECT_EQ(std::to_string(highest_level(texture)), chosen["lattice_level"]);
  EXPECT_EQ(texture.mlp.has_value(), chosen["color"] == "network");
  EXPECT_EQ(kept.quality, Quality{});
  const ChildResult drawn =
      run({"render", "fast.glb", "--size", "64x48", "--context", "osmesa", "--json"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
}

// The photographs are the scene's own images, so unreduced drawing equals them exactly.
TEST_F(Tradeoff, PhotographsHaveAnErrorOfTheirOwn) {
  write_soup();
  photograph("soup.glb");
  const ChildResult result =
      run({"tradeoff", "soup.glb", "data", "--quick", "--context", "osmesa", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["e_model"]["photographs"], 2);
  int faithful = 0, coarse = 0, published = 0;
  for (const auto& each : json["drawing"]["configurations"]) {
    // Generic twins draw the images of the specialised configuration, so they have no error of
    // their own.
    EXPECT_EQ(each["e_model"].is_null(), each["method"] == "tureen --no-specialise");
    if (each["e_model"].is_null()) continue;
    if (each["method"] == "published") {
      // The baseline truncates where the photographs do not, but draws the same soup. A wrong image
      // of this soup has less than 30 dB, as lattice level 0 has.
      EXPECT_LT(each["e_model"]["psnr_db"], 100);
      EXPECT_GT(each["e_model"]["psnr_db"], 35);
      ++published;
    } else if (each["name"] == "defaults") {
      EXPECT_EQ(each["e_model"]["psnr_db"], 100);
      ++faithful;
    } else if (each["knobs"]["lattice_level"] == "0") {
      EXPECT_LT(each["e_model"]["psnr_db"], 50) << each["name"];
      ++coarse;
    }
  }
  EXPECT_EQ(faithful, 1);
  EXPECT_EQ(published, 1);
  EXPECT_GT(coarse, 0);
}

TEST_F(ThoroughTradeoff, SupersamplingAsTheReferenceDoesIsOnNoFront) {
  write_soup();
  const ChildResult result =
      run({"tradeoff", "soup.glb", "--full", "--size", "32x24", "--cameras", "hemisphere:1",
           "--rounds", "1", "--combinations", "4", "--no-flip", "--context", "osmesa", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  const auto fine = antialiased(json, {{"supersampling", "8"}});
  ASSERT_FALSE(fine.is_null());
  EXPECT_EQ(fine["on_front"], false);
  EXPECT_EQ(fine["judged"], false);
  const auto coarse = antialiased(json, {{"supersampling", "4"}});
  EXPECT_EQ(coarse["judged"], true);
  // The reason: no other antialiasing comes as close to the reference.
  EXPECT_GT(fine["e_render"]["psnr_db"], coarse["e_render"]["psnr_db"].get<double>() + 3);
  // Its error does not affect the setting's PSNR range either.
  for (const auto& setting : json["antialiasing"]["knobs"])
    if (setting["key"] == "supersampling") {
      EXPECT_LT(setting["psnr_range_db"],
                fine["e_render"]["psnr_db"].get<double>() -
                    antialiased(json, {})["e_render"]["psnr_db"].get<double>());
    }
}

/// The choice has the exact order if only that is good enough; the scene that is written has it,
/// too.
TEST_F(Tradeoff, OfSplatsVariesTheirOrderAndNumber) {
  Splats splats = test::random_splats(test::splat_kinds[0], 300, 0.3, 1);
  auto& windows = std::get<TriangleWindows>(splats.kernel);
  // A few are opaque in all but name.
  std::fill_n(windows.sigma.begin(), 20, 0.01f);
  std::fill_n(windows.opacity.begin(), 20, 0.99f);
  tureen::write_scene(scene_of(std::move(splats)), folder / "soup.glb");
  const ChildResult result =
      tradeoff({"--json", "--reference", "exact", "--combinations", "0", "--least-psnr", "42",
                "--most-mismatch", "1", "--write", "chosen.glb"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  std::vector<std::string> keys;
  for (const auto& setting : json["drawing"]["knobs"]) keys.push_back(setting["key"]);
  EXPECT_THAT(keys, testing::ElementsAre("splat_order", "splat_fraction", "opaque_windows"));
  for (const auto& each : json["drawing"]["configurations"]) {
    if (each["method"] != "tureen") continue;
    if (each["name"] == "exact order") {
      EXPECT_GE(each["e_render"]["psnr_db"], 45);
    } else {
      EXPECT_LT(each["e_render"]["psnr_db"], 40) << each["name"];
    }
  }
  EXPECT_EQ(json["choice"]["name"], "exact order");
  EXPECT_EQ(tureen::read_scene(folder / "chosen.glb").quality.splat_order,
            Quality::SplatOrder::exact);
}

TEST_F(Tradeoff, NeverOverwritesSilently) {
  write_soup();
  std::ofstream(folder / "old.glb") << "precious";
  const ChildResult result = tradeoff({"--write", "old.glb"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, Names("old.glb", "--force"));
  const ChildResult itself = tradeoff({"--write", "soup.glb", "--force"});
  EXPECT_EQ(itself.exit_code, 2);
  EXPECT_THAT(itself.err, Names("soup.glb"));
  // A missing dataset is an error before anything is measured.
  EXPECT_THAT(tradeoff({"nodata"}).err, AllOf(Names("nodata"), Not(HasSubstr(" %"))));
  EXPECT_EQ(tradeoff({"--write", "fast.ply"}).exit_code, 2);
}

TEST_F(Tradeoff, SaysThatNothingKeepsToTheLimits) {
  write_soup();
  const ChildResult result = tradeoff({"--write", "fast.glb", "--least-psnr", "100",
                                       "--combinations", "0", "--no-flip", "--size", "32x24"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_FALSE(exists("fast.glb"));
  EXPECT_THAT(result.out, IsEmpty());
}

TEST_F(Tradeoff, ExitCodesSayWhoIsToBlame) {
  write_soup();
  const auto expect = [&](const std::vector<std::string>& arguments, int code,
                          const std::string& value) {
    const ChildResult result = run(arguments);
    EXPECT_EQ(result.exit_code, code) << value;
    EXPECT_THAT(result.err, Names(value));
    EXPECT_THAT(result.out, IsEmpty());
  };
  expect({"tradeoff"}, 2, "SCENE");
  expect({"tradeoff", "soup.gbl"}, 3, "soup.glb");
  expect({"tradeoff", "soup.glb", "--size", "12"}, 2, "'12'");
  expect({"tradeoff", "soup.glb", "--reference", "exakt"}, 2, "exact");
  expect({"tradeoff", "soup.glb", "--full", "--quick"}, 2, "--quick");
  expect({"tradeoff", "soup.glb", "photos", "--quick"}, 3, "photos");
}

TEST_F(Tradeoff, CtrlCLeavesNothingBehind) {
  write_soup();
  Child child(
      {"tradeoff", "soup.glb", "--context", "osmesa", "-o", "report", "--write", "fast.glb"},
      folder);
  ASSERT_TRUE(child.wait_until([&] { return child.has_loaded("libOSMesa"); }));
  child.signal(SIGINT);
  const ChildResult result = child.wait();
  EXPECT_EQ(result.exit_code, 5);
  EXPECT_FALSE(exists("fast.glb"));
  EXPECT_FALSE(exists("report"));
}

}  // namespace tradeoff_program_test
}  // namespace tureen
