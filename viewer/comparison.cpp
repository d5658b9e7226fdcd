#include "viewer/comparison.hpp"

namespace tureen::viewer {

PlacedPhotograph place(const Camera& photograph, const Camera& view, double points_per_pixel) {
  const auto at = [&](double u, double v) {
    return points_per_pixel * glm::dvec2(view.cx + view.fx * (u - photograph.cx) / photograph.fx,
                                         view.cy + view.fy * (v - photograph.cy) / photograph.fy);
  };
  return {at(0, 0), at(photograph.width, photograph.height)};
}

}  // namespace tureen::viewer
