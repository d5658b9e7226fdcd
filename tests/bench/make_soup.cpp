// make_soup OUT: writes the large soups for `./dev bench`: a small soup with its triangles split,
// or layers with a known cost.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

#include "formats/scene_file.hpp"
#include "tests/bench/dense_soup.hpp"
#include "tests/bench/layered_soup.hpp"
#include "tests/bench/run_program.hpp"

namespace {

using namespace tureen;

int run(int argc, char** argv) {
  CLI::App app("Writes a large soup for measurements: layers, or BASE with its triangles split.");
  std::string out, base;
  test::LayeredSoupOptions layers;
  bool cut_out = false;
  app.add_option("OUT", out, "file to write")->required();
  app.add_option("--dense", base, "split the triangles of this soup instead of making layers");
  app.add_option("--triangles", layers.triangles, "number of triangles, at least")
      ->check(CLI::Range(1, 32'000'000))
      ->capture_default_str();
  app.add_option("--layers", layers.layers, "number of layers behind each other")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_flag("--cut-out", cut_out, "layers with a lattice and a color MLP, not opaque ones");
  CLI11_PARSE(app, argc, argv);

  Scene scene;
  if (base.empty()) {
    if (cut_out) layers.kind = test::LayeredSoupOptions::Kind::cut_out;
    scene = test::layered_soup(layers);
  } else {
    Scene small = read_scene(base);
    make_opaque(small);
    scene = scene_of(test::dense_soup(only_soup(small), layers.triangles));
    scene.info = small.info;
  }
  for (const std::string& note : write_scene(scene, out))
    std::fprintf(stderr, "%s\n", note.c_str());
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return tureen::test::run_program("make_soup", run, argc, argv); }
