// Makes the example soup: make_example OUT.glb. Everything in it is computed here: the shapes, the
// paint, the light and the network. The same program makes the same soup.
#include <cstdio>
#include <exception>

#include "bake.hpp"
#include "formats/scene_file.hpp"
#include "still_life.hpp"

int main(int argc, char** argv) try {
  using namespace tureen;
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_example OUT.glb\n");
    return 2;
  }
  const example::Model model = example::still_life();
  std::fprintf(stderr, "%zu triangles\n", model.faces.size());
  const example::BakeOptions options{.progress = [](const std::string& what, double fraction) {
    std::fprintf(stderr, "\r%s: %3.0f %%\033[K", what.c_str(), 100 * fraction);
  }};
  const Scene scene = example::staged(example::bake(model, options));
  std::fprintf(stderr, "\n");
  for (const std::string& lost : write_scene(scene, argv[1]))
    std::fprintf(stderr, "%s\n", lost.c_str());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "make_example: %s\n", error.what());
  return 5;
}
