#include "tests/support/golden.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "base/input.hpp"
#include "image/png.hpp"
#include "tests/support/evidence.hpp"

namespace tureen::test {

void expect_golden(const Image8& actual, const std::string& name, const std::string& variant) {
  namespace fs = std::filesystem;
  const fs::path expected_path = fs::path(TUREEN_SOURCE_DIR) / "tests/golden" / (name + ".png");
  const fs::path folder =
      fs::path(TUREEN_BINARY_DIR) /
      (variant.empty() ? "golden/" + name : "golden-variants/" + name + "-" + variant);
  fs::remove_all(folder);

  Image8 expected;
  std::size_t off = 0, off_by_more = 0;
  if (fs::exists(expected_path)) {
    Input input = Input::open(expected_path);
    expected = read_image(input);
  }
  const bool same_size = expected.width == actual.width && expected.height == actual.height;
  for (std::size_t i = 0; same_size && i < actual.pixels.size(); ++i) {
    int largest = 0;
    for (int c = 0; c < 4; ++c)
      largest = std::max(largest, std::abs(int(actual.pixels[i][c]) - int(expected.pixels[i][c])));
    off += largest > 0 ? 1 : 0;
    off_by_more += largest > 1 ? 1 : 0;
  }
  if (same_size && off * 300 <= actual.pixels.size() && off_by_more * 3000 <= actual.pixels.size())
    return;

  write_evidence(actual, folder, "actual");
  if (!expected.pixels.empty()) write_evidence(expected, folder, "expected");
  if (same_size) write_evidence(enlarged_difference(expected, actual), folder, "difference");
  ADD_FAILURE() << (expected.pixels.empty() ? "missing golden "
                    : !same_size            ? "the size differs from the golden "
                                            : "the image differs from the golden ")
                << expected_path << ": " << off << " pixels off, " << off_by_more
                << " by more than a step; see " << folder;
}

}  // namespace tureen::test
