// The depth range of a frame with several layers. tests/numerics/depth_test.cpp measures the
// precision of depth that the range leaves.
#include "scene/clip_range.hpp"

#include <gtest/gtest.h>

#include <array>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec4.hpp>
#include <vector>

namespace tureen {
namespace clip_range_test {

constexpr DepthStorage both_storages[] = {DepthStorage::fixed_24, DepthStorage::reversed_float};

const Bounds box{{-0.3f, -1.1f, 0.2f}, {0.7f, 2.3f, 1.9f}};

Camera camera_at(const glm::dvec3& eye, const glm::dvec3& target) {
  return look_at(eye, target, {0.1, 1, 0.2}, 0.7, 100, 80);
}

void expect_valid(const ClipRange& range) {
  EXPECT_GT(range.near, 0);
  EXPECT_LT(range.near, range.far);
}

TEST(ClipRange, OfOneTranslatedLayerEqualsThatOfItsBox) {
  for (const DepthStorage storage : both_storages)
    for (const glm::dvec3& place :
         {glm::dvec3(0), glm::dvec3(0.1, -2.7, 0.3), glm::dvec3(412345.67, -5123456.7, 98.7)}) {
      const std::array layers{LayerPlace{box, glm::translate(glm::dmat4(1), place)}};
      // In front of the box, inside it, and behind it.
      for (const double distance : {7.3, 0.1, -7.3}) {
        const Camera camera = camera_at(place + glm::dvec3(0.2, 0.4, distance),
                                        place + glm::dvec3(0.2, 0.4, distance - 1));
        const ClipRange range = clip_range(layers, camera, storage);
        const ClipRange expected =
            clip_range(box, camera.eye() - place, forward_of(camera), storage);
        EXPECT_EQ(range.near, expected.near);
        EXPECT_EQ(range.far, expected.far);
        expect_valid(range);
      }
    }
}

// A camera that moves with the layer sees the same image. Only the unit of length differs.
TEST(ClipRange, OfOneLayerScalesWithTheLayer) {
  const double scale = 3.7;
  const Camera camera = camera_at({4, 3, 9}, {0, 0.5, 1});
  for (const DepthStorage storage : both_storages)
    for (const bool mirrored : {false, true}) {
      glm::dmat4 rotated = glm::rotate(glm::dmat4(1), 1.2, glm::normalize(glm::dvec3(1, -2, 3)));
      if (mirrored) rotated = glm::scale(rotated, glm::dvec3(1, -1, 1));
      const glm::dvec3 place(5, -6, 7);
      const glm::dmat4 similarity = glm::translate(glm::dmat4(1), place) * rotated *
                                    glm::scale(glm::dmat4(1), glm::dvec3(scale));
      Camera moved = camera;  // orthogonal, so the transpose is the inverse
      moved.view_from_world = camera.view_from_world * glm::transpose(rotated);
      moved.view_from_world[3] = glm::dvec4(
          scale * glm::dvec3(camera.view_from_world[3]) - glm::dmat3(moved.view_from_world) * place,
          1);

      const ClipRange here = clip_range(std::array{LayerPlace{box}}, camera, storage);
      const ClipRange there = clip_range(std::array{LayerPlace{box, similarity}}, moved, storage);
      EXPECT_NEAR(there.near, scale * here.near, 1e-12 * there.near);
      EXPECT_NEAR(there.far, scale * here.far, 1e-12 * there.far);
    }
}

TEST(ClipRange, OfSeveralLayersContainsEveryCorner) {
  std::vector<LayerPlace> layers;
  for (int i = 0; i < 4; ++i) {
    glm::dmat4 place = glm::translate(glm::dmat4(1), glm::dvec3(3.0 * i, -2.0 * i, 0.5 * i));
    place = glm::rotate(place, 0.9 * i, glm::dvec3(0, 0.6, 0.8));
    layers.push_back({box, glm::scale(place, glm::dvec3(0.5 + i))});
  }
  const Camera camera = camera_at({-20, 40, 60}, {4, -3, 1});
  for (const DepthStorage storage : both_storages) {
    const ClipRange range = clip_range(layers, camera, storage);
    for (const LayerPlace& layer : layers)
      for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 point(corner & 1 ? box.high.x : box.low.x,
                               corner & 2 ? box.high.y : box.low.y,
                               corner & 4 ? box.high.z : box.low.z, 1);
        const double depth = -(camera.view_from_world * layer.world_from_layer * point).z;
        EXPECT_LT(range.near, depth);
        EXPECT_GT(range.far, depth);
      }
  }
}

// One layer would otherwise blank the image of all others.
TEST(ClipRange, OfALayerThatIsFarAwayOrEnormousClipsNoOther) {
  const Camera camera = camera_at({4, 3, 9}, {0, 0.5, 1});
  const Bounds enormous{glm::vec3(-1), glm::vec3(1e38f)};
  for (const DepthStorage storage : both_storages) {
    const ClipRange alone = clip_range(std::array{LayerPlace{box}}, camera, storage);
    for (const LayerPlace& other :
         {LayerPlace{box, glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -1e12))},
          LayerPlace{box, glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 1e300))},
          LayerPlace{enormous}}) {
      const ClipRange range = clip_range(std::array{LayerPlace{box}, other}, camera, storage);
      expect_valid(range);
      EXPECT_LE(range.near, alone.near);
      EXPECT_GE(range.far, alone.far);
    }
  }
}

// The layer lies 5e6 from the world's origin, where an empty layer's box is.
TEST(ClipRange, DoesNotChangeWithAnEmptyLayer) {
  const glm::dvec3 place(412345.67, -5123456.7, 98.7);
  const LayerPlace layer{box, glm::translate(glm::dmat4(1), place)};
  const Camera camera = camera_at(place + glm::dvec3(4, 3, 9), place);
  for (const DepthStorage storage : both_storages) {
    const ClipRange expected = clip_range(std::array{layer}, camera, storage);
    for (const auto& layers : {std::array{layer, LayerPlace{}}, std::array{LayerPlace{}, layer}}) {
      const ClipRange range = clip_range(layers, camera, storage);
      EXPECT_EQ(range.near, expected.near);
      EXPECT_EQ(range.far, expected.far);
    }
  }
}

TEST(ClipRange, IsValidWithoutAnythingToSee) {
  const Camera camera = camera_at({4, 3, 9}, {0, 0.5, 1});
  for (const DepthStorage storage : both_storages)
    for (std::size_t count = 0; count < 3; ++count)
      expect_valid(clip_range(std::vector<LayerPlace>(count), camera, storage));
}

}  // namespace clip_range_test
}  // namespace tureen
