// make_dense_soup BASE OUT: writes the large opaque soup that frames are timed with
// (dense_soup.hpp).
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "bench/dense_soup.hpp"
#include "formats/scene_file.hpp"

int main(int argc, char** argv) {
  try {
    CLI::App app("Writes a large opaque soup, made of BASE by splitting its triangles");
    std::string base, out;
    std::size_t triangles = 2000000;
    app.add_option("BASE", base, "any small soup")->required();
    app.add_option("OUT", out, "the file to write")->required();
    app.add_option("--triangles", triangles, "at least this many");
    CLI11_PARSE(app, argc, argv);
    tureen::Scene scene = tureen::read_scene(base);
    scene.primitives =
        tureen::testing::dense_soup(std::get<tureen::TriangleSoup>(scene.primitives), triangles);
    // Knobs of the base's were chosen for another soup.
    scene.preset.reset();
    for (const std::string& note : tureen::write_scene(scene, out))
      std::fprintf(stderr, "%s\n", note.c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 5;
  }
}
