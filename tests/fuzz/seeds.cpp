// make_fuzz_seeds FOLDER: writes the initial inputs of fuzzers, FOLDER/TARGET/NAME.
#include <cstdio>
#include <filesystem>

#include "base/output.hpp"
#include "tests/fuzz/fixtures.hpp"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_fuzz_seeds FOLDER\n");
    return 2;
  }
  for (const tureen::fuzz::Fixture& fixture : tureen::fuzz::fixtures()) {
    const auto folder = std::filesystem::path(argv[1]) / fixture.target;
    std::filesystem::create_directories(folder);
    tureen::write_file(folder / fixture.name, fixture.bytes);
  }
}
