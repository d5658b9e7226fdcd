#include "scene/quality.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tureen {
namespace quality_test {

TEST(Quality, TheDefaultIsOneSampleAPixel) {
  EXPECT_EQ(defect(Quality{}), std::nullopt);
  EXPECT_EQ(describe(Quality{}), "one sample per pixel");
  EXPECT_EQ(describe({.resolution_scale = 0.75}), "75 % of the rows and columns");
  EXPECT_EQ(describe({.supersampling = 3}), "3 x 3 samples per pixel");
  EXPECT_EQ(describe({.splat_order = Quality::SplatOrder::exact}), "splats in exact order");
  EXPECT_EQ(describe({.supersampling = 2, .splat_order = Quality::SplatOrder::stochastic}),
            "2 x 2 samples per pixel, stochastic splats");
}

TEST(Quality, WhatCannotBeDrawnHasADefect) {
  for (const Quality& good : {Quality{.resolution_scale = 0.25}, Quality{.supersampling = 8}})
    EXPECT_EQ(defect(good), std::nullopt) << describe(good);
  for (const Quality& bad :
       {Quality{.resolution_scale = 0.2}, Quality{.resolution_scale = 1.5},
        Quality{.resolution_scale = NAN}, Quality{.supersampling = 0}, Quality{.supersampling = 9},
        Quality{.resolution_scale = 0.5, .supersampling = 2},
        Quality{.splat_order = Quality::SplatOrder(3)}})
    EXPECT_TRUE(defect(bad)) << describe(bad);
}

}  // namespace quality_test
}  // namespace tureen
