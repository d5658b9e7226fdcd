// Splats in the coordinates of another frame look the same from there.
#include "scene/edit/moved_splats.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "oracle/oracle.hpp"
#include "tests/support/random_splats.hpp"

namespace tureen {
namespace moved_splats_test {

class MovedSplats : public testing::TestWithParam<test::SplatKind> {};

TEST_P(MovedSplats, LookTheSame) {
  for (const double side : {1.3, -1.3}) {
    SCOPED_TRACE(side);
    const glm::dmat4 place =
        glm::scale(glm::rotate(glm::translate(glm::dmat4(1), glm::dvec3(0.2, -0.1, 0.3)), 2.0,
                               glm::dvec3(0.2, -0.5, 0.7)),
                   glm::dvec3(side, 1.3, 1.3));
    Scene scene;
    scene.layers.push_back(
        {.world_from_layer = place, .primitives = test::random_splats(GetParam(), 300, 0.2, 4)});
    const Camera camera = test::camera_of_ball(4, 48, 36);
    OracleOptions options;
    options.splat_stop = false;
    const OracleImage expected = render_oracle(scene, {camera}, options);

    auto& splats = std::get<Splats>(scene.layers[0].primitives);
    scene.layers[0].world_from_layer = glm::dmat4(1);
    const OracleImage unmoved = render_oracle(scene, {camera}, options);
    move_splats(splats, place);
    const OracleImage moved = render_oracle(scene, {camera}, options);
    const auto change = [&](const OracleImage& image) {
      double most = 0;
      for (std::size_t i = 0; i < image.color.pixels.size(); ++i)
        for (int k = 0; k < 3; ++k)
          most = std::max(most,
                          std::abs(double(image.color.pixels[i][k] - expected.color.pixels[i][k])));
      return most;
    };
    // Values are rounded to floats. At a pixel where a splat fades to 1/255, that splat may be
    // drawn in one image alone: 1/255 of a colour of at most 2.
    EXPECT_LT(change(moved), 2.0 / 255);
    EXPECT_GT(change(unmoved), 0.1);
  }
}

INSTANTIATE_TEST_SUITE_P(, MovedSplats, testing::ValuesIn(test::splat_kinds),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace moved_splats_test
}  // namespace tureen
