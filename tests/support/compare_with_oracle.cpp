// compare_with_oracle SCENE.glb BLACK.png WHITE.png: compares images that another program drew with
// the oracle, and prints the differences as JSON. The images show the scene's first camera, over
// black and over white: pixels that are equal in both are covered, because triangles are opaque or
// cut out.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.hpp"
#include "base/input.hpp"
#include "formats/scene_file.hpp"
#include "image/png.hpp"
#include "oracle/oracle.hpp"

namespace tureen::test {
namespace {

Image8 read_png(const char* path) {
  Input input = Input::open(path);
  return read_image(input);
}

bool covers(const Image8& black, const Image8& white, std::size_t pixel) {
  return glm::u8vec3(black.pixels[pixel]) == glm::u8vec3(white.pixels[pixel]);
}

/// Colours are compared where both images are covered, before the oracle's are rounded to 8 bits.
nlohmann::json differences(const OracleImage& oracle, const Image8& black, const Image8& white) {
  std::size_t covered = 0, coverage_mismatch = 0;
  double squares = 0;
  std::vector<double> values;
  for (std::size_t i = 0; i < black.pixels.size(); ++i) {
    const bool here = covers(black, white, i), there = oracle.face[i] != OracleImage::no_face;
    coverage_mismatch += here != there;
    if (!here || !there) continue;
    ++covered;
    for (int c = 0; c < 3; ++c) {
      const double d = double(oracle.color.pixels[i][c]) - black.pixels[i][c] / 255.0;
      squares += d * d;
      values.push_back(std::abs(d));
    }
  }
  if (values.empty()) throw InputError({}, "no pixel is covered in both images");
  std::sort(values.begin(), values.end());
  const auto pixels = double(black.pixels.size());
  // The floor stands for equal images.
  return {{"psnr_db", 10 * std::log10(double(values.size()) / std::max(squares, 1e-12))},
          {"p999_abs", values[(values.size() - 1) * 999 / 1000]},
          {"max_abs", values.back()},
          {"coverage_mismatch", double(coverage_mismatch) / pixels},
          {"compared", double(covered) / pixels}};
}

int compare(char** paths) {
  const Scene scene = read_scene(paths[0]);
  const Image8 black = read_png(paths[1]), white = read_png(paths[2]);
  const Camera& camera = scene.cameras.at(0);
  for (const Image8* image : {&black, &white})
    if (image->width != camera.width || image->height != camera.height)
      throw InputError({}, "the images do not have the size of the scene's first camera");
  const OracleImage oracle =
      render_oracle(scene, {camera}, {.rays = {.coverage = oracle::Coverage::snapped}});
  std::printf("%s\n", differences(oracle, black, white).dump().c_str());
  return 0;
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: compare_with_oracle SCENE BLACK.png WHITE.png\n");
    return 2;
  }
  try {
    return tureen::test::compare(argv + 1);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 5;
  }
}
