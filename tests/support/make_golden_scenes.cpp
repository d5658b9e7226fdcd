// make_golden_scenes EXAMPLE OUT: writes the scenes of support/golden_scenes.hpp into the folder
// OUT, for other programs that draw them. NAME.glb belongs to tests/golden/NAME.png.
// debug_views.glb is the scene of the debug views,
// example_KIND.glb is the example as splats, and the folder diffsoup is one soup as a
// DiffSoup export.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <string_view>

#include "formats/scene_file.hpp"
#include "tests/support/golden_scenes.hpp"
#include "tests/support/soup_splats.hpp"

namespace tureen::test {
namespace {

void write_all(const std::filesystem::path& example, const std::filesystem::path& folder) {
  for (const Kind kind : all_kinds)
    write_scene(golden_scene(kind), folder / (to_string(kind) + ".glb"));

  write_scene(golden_debug_view_scene(read_scene(example)), folder / "debug_views.glb");

  write_scene(golden_splats(), folder / "splats.glb");
  write_scene(golden_layers(read_scene(example)), folder / "layers.glb");

  // The images in docs/splats.md.
  Scene around = read_scene(example);
  glm::dvec3 place(-4.0, 2.2, 1.0);  // behind, then inside, then in front
  for (const char* name : {"windows", "discs_2dgs", "neural"}) {
    Scene splats = read_scene(example);
    for (const SplatKind& kind : splat_kinds)
      if (std::string_view(kind.name) == name)
        splats.layers[0].primitives = splats_of(only_soup(splats), kind);
    write_scene(splats, folder / ("example_" + std::string(name) + ".glb"));
    around.layers.push_back(splats.layers[0]);
    around.layers.back().world_from_layer =
        glm::scale(glm::translate(glm::dmat4(1.0), place), glm::dvec3(0.7)) *
        splats.layers[0].world_from_layer;
    place += glm::dvec3(3.0, -2.1, 0.1);
  }
  write_scene(around, folder / "example_around.glb");

  // An export has one lattice level.
  Scene exported = golden_scene(Kind::lattice_mlp);
  only_soup(exported) =
      random_soup(2026, {.kind = Kind::lattice_mlp, .faces = 150, .size = 0.25, .level = 4});
  write_scene(exported, folder / "diffsoup");
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: make_golden_scenes EXAMPLE OUT\n");
    return 2;
  }
  try {
    tureen::test::write_all(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 5;
  }
  return 0;
}
