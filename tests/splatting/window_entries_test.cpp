// The tiles of triangles against the pixel centres inside of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "splatting/windows/window_kernels.hpp"
#include "tests/support/random.hpp"

namespace tureen::test {
namespace window_entries_test {

constexpr int width = 93, height = 61;  // no multiples of a tile

/// Whether a pixel centre is inside, by more than a float's rounding of the coordinates.
bool is_inside(const splatting::WindowOutline& o, double x, double y) {
  double largest = 1;
  for (const float value : o) largest = std::max(largest, std::abs(double(value)));
  bool left = true, right = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t n = (k + 1) % 3;
    const double dx = double(o[2 * n]) - double(o[2 * k]);
    const double dy = double(o[2 * n + 1]) - double(o[2 * k + 1]);
    const double side = dx * (y - double(o[2 * k + 1])) - dy * (x - double(o[2 * k]));
    const double margin = 1e-6 * largest * std::hypot(dx, dy);
    left &= side > margin;
    right &= side < -margin;
  }
  return left || right;
}

/// Expects each tile with a pixel centre inside the triangle in the lists; returns their number.
int expect_tiles(const splatting::WindowOutline& outline, int number) {
  splatting::TileLists lists;
  lists.begin(width, height);
  splatting::list_window(outline, 7, lists);
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
          needed |= is_inside(outline, x + 0.5, y + 0.5);
      EXPECT_TRUE(!needed || lists.tile(column, row).size() == 1)
          << "outline " << number << ", tile " << column << ", " << row;
    }
  }
  return listed;
}

TEST(WindowEntries, AreInEachTileWithAPixelCenterInside) {
  Random random(1);
  for (int number = 0; number < 3000; ++number) {
    const double size = std::exp(random.uniform(0, 9));  // from 1 to 8,000 px
    const double middle[2] = {random.uniform(-20, width + 20), random.uniform(-20, height + 20)};
    splatting::WindowOutline outline;
    for (std::size_t k = 0; k < 6; ++k)
      outline[k] = float(middle[k % 2] + size * random.uniform(-1, 1));
    if (number % 4 == 1) outline[3] = outline[1];                           // a level side
    if (number % 4 == 2) outline[4] = outline[2], outline[5] = outline[3];  // two equal corners
    expect_tiles(outline, number);
  }
}

TEST(WindowEntries, AreInFewOtherTiles) {
  // A thin triangle across the image: a tile in each column and a few more.
  EXPECT_LE(expect_tiles({0, 0, 90, 58, 92, 58}, 0), 2 * 12);
  EXPECT_EQ(expect_tiles({9, 9, 15, 9, 12, 15}, 1), 1);
  EXPECT_EQ(expect_tiles({-30, 5, -9, 5, -12, 30}, 2), 0);
}

}  // namespace window_entries_test
}  // namespace tureen::test
