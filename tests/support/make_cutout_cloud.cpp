// make_cutout_cloud OUT: writes the soup for measurements of speed and agreement
// (support/cutout_cloud.hpp), in any format that tureen writes. Without an extension, OUT is the
// folder of a DiffSoup export.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <map>
#include <string>

#include "formats/scene_file.hpp"
#include "scene/lattice.hpp"
#include "tests/support/cutout_cloud.hpp"

namespace {

int run(int argc, char** argv) {
  using tureen::test::CloudCoverage;
  CLI::App app("Writes the cut-out cloud, a random soup with a color MLP.");
  std::string out;
  tureen::test::CutoutCloudOptions options;
  const std::map<std::string, CloudCoverage> coverages{
      {"third", CloudCoverage::third},
      {"forty_percent", CloudCoverage::forty_percent},
      {"all", CloudCoverage::all}};
  app.add_option("OUT", out, "File or folder to write")->required();
  app.add_option("--triangles", options.triangles)->check(CLI::Range(1, 10'000'000));
  app.add_option("--level", options.level)->check(CLI::Range(0, tureen::lattice::max_level));
  app.add_option("--seed", options.seed);
  app.add_option("--coverage", options.coverage, "How much of the views it covers")
      ->transform(CLI::CheckedTransformer(coverages));
  CLI11_PARSE(app, argc, argv);
  for (const std::string& note : tureen::write_scene(tureen::test::cutout_cloud(options), out))
    std::fprintf(stderr, "%s\n", note.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 5;
  }
}
