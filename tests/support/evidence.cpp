#include "tests/support/evidence.hpp"

#include <algorithm>
#include <cstdlib>

#include "base/output.hpp"
#include "image/png.hpp"

namespace tureen::test {

void write_evidence(const Image8& image, const std::filesystem::path& folder,
                    const std::string& name) {
  std::filesystem::create_directories(folder);
  Output output(folder / (name + ".png"));
  output.write(encode_png(image));
  output.commit();
}

Image8 enlarged_difference(const Image8& a, const Image8& b) {
  Image8 result(a.width, a.height, glm::u8vec4(0, 0, 0, 255));
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c)
      result.pixels[i][c] =
          std::uint8_t(std::min(255, 16 * std::abs(int(a.pixels[i][c]) - int(b.pixels[i][c]))));
  return result;
}

}  // namespace tureen::test
