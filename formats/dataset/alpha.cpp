#include "formats/dataset/alpha.hpp"

#include <algorithm>

namespace tureen {

namespace {

/// Scaled photographs have a pixel with a little transparency where one source pixel in 40 has it;
/// its colour is that of the others.
constexpr int opaque_from = 250;

bool is_transparent(const glm::u8vec4& pixel) { return pixel.a < 128; }

}  // namespace

AlphaCounts alpha_counts(const Image8& image) {
  std::size_t all = 0, border = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (!is_transparent(image.at(x, y))) continue;
      ++all;
      border += x == 0 || y == 0 || x == image.width - 1 || y == image.height - 1;
    }
  const auto sides = std::min<std::size_t>(
      2 * std::size_t(image.width) + 2 * std::size_t(image.height) - 4, image.pixels.size());
  return {double(all) / double(image.pixels.size()), double(border) / double(sides)};
}

AlphaUse alpha_of(const std::vector<AlphaCounts>& photographs) {
  AlphaUse use;
  std::size_t cut_out = 0;
  for (const AlphaCounts& counts : photographs) {
    use.photographs += counts.all > 0.001;
    cut_out += counts.all >= 0.25 && counts.border >= 0.5;
  }
  if (use.photographs > 0)
    use.meaning = 2 * cut_out >= photographs.size() ? AlphaMeaning::background : AlphaMeaning::mask;
  return use;
}

void apply_alpha(AlphaMeaning meaning, Photograph& photograph) {
  if (meaning == AlphaMeaning::background || photograph.image.is_opaque()) return;
  if (meaning == AlphaMeaning::mask) {
    const Image8 image = photograph.image();
    std::vector<std::uint8_t> ignored = photograph.ignored();
    ignored.resize(image.pixels.size());
    for (std::size_t i = 0; i < ignored.size(); ++i) ignored[i] |= image.pixels[i].a < opaque_from;
    const auto count = std::size_t(std::ranges::count(ignored, 1));
    if (count > 0 && count < ignored.size()) {
      photograph.ignored = std::move(ignored);
      if (photograph.file()) photograph.ignored.move_to(photograph.file());
    }
  }
  photograph.image.remove_alpha();
}

}  // namespace tureen
