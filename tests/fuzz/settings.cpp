// The settings that the window stores between runs.
#include "viewer/files/settings.hpp"

#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void settings(Bytes bytes) {
  static const Scratch scratch("settings");
  scratch.write("viewer.json", bytes);
  const viewer::Settings settings = viewer::read_settings(scratch.folder() / "viewer.json");
  if (settings.window.x < 1 || settings.window.y < 1 ||
      settings.recent.size() > viewer::most_recent) {
    std::fprintf(stderr, "settings outside their ranges\n");
    std::abort();
  }
}

}  // namespace tureen::fuzz
