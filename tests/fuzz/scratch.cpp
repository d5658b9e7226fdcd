#include "tests/fuzz/scratch.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace tureen::fuzz {

namespace fs = std::filesystem;

void require_whole(const Scene& scene) {
  for (const Layer& layer : scene.layers) {
    auto reason = defect(layer);
    if (!reason)
      reason =
          std::visit([](const auto& primitives) { return defect(primitives); }, layer.primitives);
    if (!reason) continue;
    std::fprintf(stderr, "a reader returned a scene with a defect: %s\n", reason->c_str());
    std::abort();
  }
}

Scratch::Scratch(const std::string& name)
    : folder_(fs::temp_directory_path() / ("tureen_fuzz_" + name + std::to_string(getpid()))) {
  fs::remove_all(folder_);
  fs::create_directories(folder_);
}

Scratch::~Scratch() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void Scratch::write(const std::string& name, Bytes bytes) const {
  write(name, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

void Scratch::write(const std::string& name, std::string_view text) const {
  fs::create_directories((folder_ / name).parent_path());
  std::ofstream(folder_ / name, std::ios::binary).write(text.data(), std::streamsize(text.size()));
}

}  // namespace tureen::fuzz
