// Blended splats against the oracle, in centre order.
#include <gtest/gtest.h>

#include <cmath>

#include "oracle/oracle.hpp"
#include "runtime/renderer.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen::test {
namespace splats_test {

Renderer renderer_of_scene(const gl::Context& context, const Scene& scene,
                           const RenderOptions& options = {}) {
  return Renderer(context, prepare_scene(scene, device_limits(context.capabilities()), options),
                  options);
}

using Case = std::tuple<NamedContext, SplatKind>;

class SplatsOfKind : public testing::TestWithParam<Case> {
 protected:
  gl::Context context = gl::Context::create(std::get<0>(GetParam()).request);
  SplatKind kind = std::get<1>(GetParam());
};

TEST_P(SplatsOfKind, AreDrawn) {
  const Scene scene = scene_of(random_splats(kind, 2000, 0.08, 1));
  Renderer renderer = renderer_of_scene(context, scene);
  for (const double distance : {3.0, 0.7}) {
    renderer.draw({camera_of_ball(distance, 320, 240)});
    const std::vector<glm::vec4> pixels = renderer.read_splats();
    double sum = 0;
    for (const glm::vec4& pixel : pixels) {
      ASSERT_TRUE(std::isfinite(pixel.r) && std::isfinite(pixel.g) && std::isfinite(pixel.b));
      ASSERT_GE(pixel.a, 0);
      ASSERT_LE(pixel.a, 1.00001);
      sum += pixel.a;
    }
    printf("mean alpha %g\n", sum / double(pixels.size()));
    const Image8 image = renderer.read_color();
    FILE* f = fopen(("/tmp/log/" + std::string(kind.name) + (distance > 1 ? "_far" : "_near") + ".ppm").c_str(), "w");
    fprintf(f, "P6\n%d %d\n255\n", image.width, image.height);
    for (auto& p : image.pixels) fwrite(&p, 1, 3, f);
    fclose(f);
  }
}

INSTANTIATE_TEST_SUITE_P(, SplatsOfKind,
                         testing::Combine(testing::ValuesIn(every_context),
                                          testing::ValuesIn(splat_kinds)),
                         [](const auto& each) {
                           return std::string(std::get<0>(each.param).name) + "_" +
                                  std::get<1>(each.param).name;
                         });

}  // namespace splats_test
}  // namespace tureen::test
