// The report page contains its data unchanged, and rejects files that are not results.
#include "jobs/report/report_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/output.hpp"
#include "cli/files/report_results.hpp"
#include "cli/files/result_files.hpp"
#include "tests/cli/tradeoff_fixture.hpp"
#include "tests/formats/format_testing.hpp"
#include "tests/support/errors.hpp"

namespace tureen::cli {
namespace report_page_test {

namespace fs = std::filesystem;
using nlohmann::json;
using test::ErrorAt;
using test::ErrorIn;
using ::testing::SizeIs;
using tureen::test::TemporaryFolder;

/// Ends a script element, opens a comment, and has a non-ASCII character.
const std::string hostile = "</script><!-- \xc3\xa9 \\ \" &lt;";

json measurements() {
  return {{"format", "tureen measurements"},
          {"version", 1},
          {"name", hostile},
          {"tables", {{"cases", {{{"case", hostile}, {"ours", 1e-300}}}}}}};
}

json eval() {
  return {{"views", {{{"name", hostile}, {"psnr_db", 30.125}}}}, {"mean", {{"psnr_db", 30.125}}}};
}

json tradeoff() {
  json result = test::lego();
  result["scene"]["name"] = hostile;
  return result;
}

json bench() {
  return json::parse(R"({"format": "tureen bench", "version": 2, "date": "",
    "program": {"version": "", "commit": "", "arguments": ["a b"]},
    "scene": {"name": "s", "path": "", "triangles": 1, "appearance": ""},
    "machine": {"cpu": "", "cores": 1, "memory_mib": 1},
    "device": {"context": "", "renderer": "", "vendor": "", "version": "", "software": true},
    "protocol": {"clock": "", "rounds": 1, "aa_spread": 0},
    "load": {"read_ms": 1, "plan_ms": 1, "upload_ms": 1, "peak_mib": 1, "device_mib": 1},
    "configurations": [],
    "measurements": [{"configuration": "tureen", "camera_set": "orbit:1", "size": "64x48",
      "width": 64, "height": 48, "views": 1, "rounds": 1, "frames_per_sample": 1, "frames": 1,
      "frame_ms": {"mean": 1, "median": 1, "p95": 1, "p99": null, "min_of_medians": 1, "spread": 0},
      "fps": 1000, "low_1_percent_fps": null, "aa_spread": 0, "stable": true, "passes_ms": null,
      "passes_gap": "no_timers", "passes_reason": "a", "gpu_ms": null, "views_ms": [1],
      "pixels_hash": "0", "picture": null}],
    "notes": ["</script>"], "key": "not known"})");
}

/// The data that the page's script finds.
json data_of(const std::string& page) {
  const std::string begin = R"(<script type="application/json" id="data">)";
  const std::size_t at = page.find(begin) + begin.size();
  const std::string text = page.substr(at, page.find("</script>", at) - at);
  EXPECT_EQ(text.find('<'), std::string::npos);
  return json::parse(text);
}

class ReportPage : public ::testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text) const {
    write_file(folder / name, text);
    return (folder / name).string();
  }
  json shown(const std::string& path) const {
    return data_of(results::report_page(read_results(path), folder / "page.html"));
  }
  std::optional<test::Refusal> refusal(const std::string& text) const {
    const std::string path = file("bad.json", text);
    return test::error_of<InputError>([&] { read_results(path); });
  }

  TemporaryFolder folder;
};

TEST_F(ReportPage, HoldsTheDataOfEveryKindAsItWas) {
  for (const auto& [kind, document] : {std::pair("measurements", measurements()),
                                       {"eval", eval()},
                                       {"tradeoff", tradeoff()},
                                       {"bench", bench()}}) {
    for (const char* mark : {"", "\xef\xbb\xbf"}) {
      const json data = shown(file(std::string(kind) + ".json", mark + document.dump(1)));
      ASSERT_THAT(data, SizeIs(1)) << kind;
      EXPECT_EQ(data[0]["kind"], kind);
      EXPECT_EQ(data[0]["data"], document) << kind;
      EXPECT_EQ(data[0]["folder"], "") << "the file is beside the page";
    }
  }
}

TEST_F(ReportPage, OfALogHoldsItsCompleteLines) {
  const json record{{"step", 50},         {"seconds", 1.5},        {"loss", nullptr},
                    {"l1", 0.1},          {"ssim", 0.5},           {"train_psnr_db", 20.5},
                    {"triangles", 15000}, {"it_per_second", 33.5}, {"non_finite", 0}};
  nlohmann::ordered_json line{{"step", 50}};
  line.update(record);
  const std::string text = line.dump();
  const json data = shown(file("log.jsonl", text + "\n" + text.substr(0, 30)));
  EXPECT_EQ(data[0]["kind"], "training");
  EXPECT_EQ(data[0]["data"], json::array({record}));
  EXPECT_THAT(refusal(text), ErrorIn("bad.json"));
  EXPECT_THAT(refusal(text + "\n{}\n"), ErrorAt("bad.json:2"));
}

TEST_F(ReportPage, OfADownloadOfThePageHoldsResultsOfBench) {
  const json data = shown(std::string(TUREEN_SOURCE_DIR) + "/tests/jobs/web_bench.json");
  EXPECT_EQ(data[0]["kind"], "bench");
  EXPECT_EQ(data[0]["data"]["device"]["renderer"], "Adreno (TM) 740");
  EXPECT_THAT(data[0]["data"]["measurements"], SizeIs(3));
}

TEST_F(ReportPage, OfAFolderHoldsAllResultsInIt) {
  make_folder(folder / "a b/deep");
  file("a b/deep/eval.json", eval().dump());
  file("a b/bench.json", bench().dump());
  file("a b/transforms.json", "{\"frames\": []}");
  const json data = shown((folder / "a b").string());
  ASSERT_THAT(data, SizeIs(2));
  EXPECT_EQ(data[0]["folder"], "a%20b/");
  EXPECT_EQ(data[1]["folder"], "a%20b/deep/");
  file("a b/bad.json", "{");
  EXPECT_THAT(test::error_of<InputError>([&] { read_results(folder / "a b"); }),
              ErrorIn("bad.json"));
  EXPECT_THROW(read_results(folder / "a b/none"), InputError);
}

TEST_F(ReportPage, RefusesWhatItCannotShowWithThePlace) {
  for (const char* text : {"", "{", "[]", "3", "{}", R"({"format": "tureen growth"})",
                           R"({"format": ["tureen bench"]})", "{\"step\":1}\n"})
    EXPECT_THAT(refusal(text), ErrorIn("bad.json")) << text;
  const auto without = [&](json document, const char* key) {
    document.erase(key);
    return refusal(document.dump());
  };
  EXPECT_THAT(without(bench(), "scene"), ErrorIn("bad.json", "scene"));
  EXPECT_THAT(without(tradeoff(), "antialiasing"), ErrorIn("bad.json", "antialiasing"));
  EXPECT_THAT(without(measurements(), "tables"), ErrorIn("bad.json", "tables"));
  json no_number = eval();
  no_number["views"][0]["psnr_db"] = "30";
  EXPECT_THAT(refusal(no_number.dump()), ErrorIn("bad.json", "views[0].psnr_db"));
  json newer = tradeoff();
  newer["version"] = 99;
  EXPECT_THAT(refusal(newer.dump()), ErrorIn("bad.json", "version"));
}

TEST_F(ReportPage, WritesAResultWithItsPage) {
  write_result(folder / "new/out", "eval", eval().dump());
  std::ifstream stream(folder / "new/out/report.html");
  const json data = data_of({std::istreambuf_iterator<char>(stream), {}});
  EXPECT_EQ(data[0]["data"], eval());
  EXPECT_EQ(data[0]["folder"], "");
  EXPECT_TRUE(fs::exists(folder / "new/out/eval.json"));
}

}  // namespace report_page_test
}  // namespace tureen::cli
