// Which tiles get a splat, and in which order, as known values.
#include "splatting/tiles/tile_lists.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

namespace tureen::splatting {
namespace tile_lists_test {

using testing::ElementsAre;
using testing::IsEmpty;

using Range = std::pair<int, int>;

/// The lists for an image of 21 x 16 pixels: 3 columns and 2 rows of tiles.
TileLists lists_of_six() {
  TileLists lists;
  lists.begin(21, 16);
  return lists;
}

std::vector<std::uint32_t> splats_at(TileLists& lists, int column, int row) {
  lists.finish(row);
  const auto splats = lists.tile(column, row);
  return {splats.begin(), splats.end()};
}

TEST(TileLists, CoverTheImage) {
  TileLists lists = lists_of_six();
  EXPECT_EQ(lists.columns(), 3);
  EXPECT_EQ(lists.rows(), 2);
  lists.begin(8, 9);
  EXPECT_EQ(lists.columns(), 1);
  EXPECT_EQ(lists.rows(), 2);
}

/// Tile 1 has its pixel centres from 8.5 to 15.5.
TEST(TileLists, HaveTheTilesWithPixelCentersInTheRange) {
  const TileLists lists = lists_of_six();
  EXPECT_EQ(lists.columns_between(8.5f, 15.5f), Range(1, 2));
  EXPECT_EQ(lists.columns_between(7.4f, 8.5f), Range(0, 2));
  EXPECT_EQ(lists.columns_between(15.6f, 16.6f), Range(2, 3));
  EXPECT_EQ(lists.columns_between(-100.0f, 0.5f), Range(0, 1));
  EXPECT_EQ(lists.columns_between(-100.0f, 100.0f), Range(0, 3));
  EXPECT_EQ(lists.rows_between(-100.0f, 100.0f), Range(0, 2));
  EXPECT_EQ(lists.rows_between(8.5f, 8.5f), Range(1, 2));
  EXPECT_EQ(lists.columns_between(-9.0f, 0.4f), Range(0, 0));
  EXPECT_EQ(lists.rows_between(16.5f, 20.0f), Range(0, 0));
  EXPECT_EQ(lists.rows_between(NAN, 3.0f), Range(0, 0));
  EXPECT_EQ(lists.rows_between(3.0f, NAN), Range(0, 0));
  EXPECT_FLOAT_EQ(TileLists::band(1).low, 8.5f);
  EXPECT_FLOAT_EQ(TileLists::band(1).high, 15.5f);
}

TEST(TileLists, KeepTheOrderInWhichSplatsWereAdded) {
  TileLists lists = lists_of_six();
  lists.add(0, 8.5f, 30.0f, 9);
  lists.add({.left = 0.5f, .right = 9.0f, .top = 0.5f, .bottom = 9.0f}, 4);
  lists.add_everywhere(7);
  lists.add_columns(1, 2, 2, 5);  // no column
  EXPECT_THAT(splats_at(lists, 0, 0), ElementsAre(4u, 7u));
  EXPECT_THAT(splats_at(lists, 1, 0), ElementsAre(9u, 4u, 7u));
  EXPECT_THAT(splats_at(lists, 2, 0), ElementsAre(9u, 7u));
  EXPECT_THAT(splats_at(lists, 0, 1), ElementsAre(4u, 7u));
  EXPECT_THAT(splats_at(lists, 2, 1), ElementsAre(7u));
  EXPECT_EQ(lists.pairs(), 2u + 4u + 6u);
  lists.begin(21, 16);
  EXPECT_EQ(lists.pairs(), 0u);
  EXPECT_THAT(splats_at(lists, 1, 0), IsEmpty());
}

/// Pairs are numbered as they are added, and shifted per splat.
TEST(TileLists, HaveTheNumbersOfPairs) {
  TileLists lists = lists_of_six();
  lists.add_columns(0, 0, 3, 0);  // pairs 0, 1, 2
  lists.add_columns(1, 1, 2, 0);  // 3
  lists.add_columns(0, 1, 3, 1);  // 4, 5
  const std::uint32_t shifts[] = {10, std::uint32_t(-4)};
  for (const int row : {0, 1}) lists.finish_with_numbers(row, shifts);
  EXPECT_THAT(lists.pair_numbers(0, 0), ElementsAre(10u));
  EXPECT_THAT(lists.pair_numbers(1, 0), ElementsAre(11u, 0u));
  EXPECT_THAT(lists.pair_numbers(2, 0), ElementsAre(12u, 1u));
  EXPECT_THAT(lists.pair_numbers(1, 1), ElementsAre(13u));
  EXPECT_THAT(lists.tile(2, 0), ElementsAre(0u, 1u));
}

}  // namespace tile_lists_test
}  // namespace tureen::splatting
