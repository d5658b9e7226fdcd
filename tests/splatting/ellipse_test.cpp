// The tiles of ellipses against the pixel centres inside of them.
#include "splatting/ellipse.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/random.hpp"

namespace tureen::test {
namespace ellipse_test {

constexpr int width = 93, height = 61;  // no multiples of a tile

/// With these standard deviations along axes that are turned by `angle`.
splatting::Ellipse ellipse(double x, double y, double larger, double smaller, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const double xx = larger * larger * c * c + smaller * smaller * s * s;
  const double yy = larger * larger * s * s + smaller * smaller * c * c;
  const double xy = (larger * larger - smaller * smaller) * c * s;
  const double root_y = std::sqrt(yy), root_determinant = larger * smaller;
  return {.x = float(x),
          .y = float(y),
          .p = float(root_y / root_determinant),
          .q = float(-xy / root_y / root_determinant),
          .r = float(1 / root_y),
          .limit = 1,
          .half_width = float(std::sqrt(xx)),
          .half_height = float(root_y)};
}

/// Whether a pixel centre is inside, by more than the rounding of floats: `limit` is 1, and the
/// terms of p dx + q dy cancel for narrow ellipses.
bool is_inside(const splatting::Ellipse& e, double x, double y) {
  const double dx = x - double(e.x), dy = y - double(e.y);
  const double along = double(e.p) * dx, across = double(e.q) * dy, down = double(e.r) * dy;
  const double rounding = 1e-6 * (1 + std::abs(along) + std::abs(across));
  return std::hypot(std::abs(along + across) + rounding, down) < 1 - 1e-6;
}

/// Expects each tile with a pixel centre inside the ellipse in the lists; returns their number.
int expect_tiles(const splatting::Ellipse& e, int number) {
  splatting::TileLists lists;
  lists.begin(width, height);
  splatting::list_ellipse(e, 7, lists);
  int listed = 0;
  for (int row = 0; row < lists.rows(); ++row) {
    lists.finish(row);
    for (int column = 0; column < lists.columns(); ++column) {
      listed += !lists.tile(column, row).empty();
      bool needed = false;
      for (int y = row * splatting::tile_side;
           y < std::min((row + 1) * splatting::tile_side, height); ++y)
        for (int x = column * splatting::tile_side;
             x < std::min((column + 1) * splatting::tile_side, width); ++x)
          needed |= is_inside(e, x + 0.5, y + 0.5);
      EXPECT_TRUE(!needed || lists.tile(column, row).size() == 1)
          << "ellipse " << number << ", tile " << column << ", " << row;
    }
  }
  return listed;
}

TEST(Ellipse, IsInEachTileWithAPixelCenterInside) {
  Random random(1);
  for (int number = 0; number < 3000; ++number) {
    const double larger = std::exp(random.uniform(0, 7));  // from 1 to 1,100 px
    const double smaller = larger * std::exp(random.uniform(-5, 0));
    expect_tiles(ellipse(random.uniform(-20, width + 20), random.uniform(-20, height + 20), larger,
                         smaller, random.uniform(0, 2 * M_PI)),
                 number);
  }
}

TEST(Ellipse, IsInFewOtherTiles) {
  // A narrow one along the image's diagonal: two tiles in each of the eight rows, and a few more.
  EXPECT_LE(expect_tiles(ellipse(46, 30, 55, 1, std::atan2(61.0, 93.0)), 0), 3 * 8);
  EXPECT_EQ(expect_tiles(ellipse(12, 12, 3, 2, 1), 1), 1);
  EXPECT_EQ(expect_tiles(ellipse(-9, 12, 8, 2, 0), 2), 0);
}

}  // namespace ellipse_test
}  // namespace tureen::test
