#include "soup/render_preset.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "soup/triangle_soup.hpp"

namespace tureen {
namespace {

using ::testing::HasSubstr;

TEST(RenderPreset, TheDefaultIsFaithfulAndValid) {
  const RenderPreset preset;
  EXPECT_TRUE(is_faithful(preset));
  EXPECT_TRUE(keeps_data(preset));
  EXPECT_EQ(describe(preset), "faithful");
  EXPECT_EQ(defect(preset), std::nullopt);
  EXPECT_TRUE(is_faithful({.promised_psnr_db = 51.0}));
}

struct Turned {
  RenderPreset preset;
  bool keeps_data;
  const char* words;
};

TEST(RenderPreset, EveryKnobIsSaid) {
  using Preset = RenderPreset;
  const Turned turned[] = {
      {{.lattice_level = 3}, false, "lattice level at most 3"},
      {{.texel_bits = 8}, false, "8 bits a texel channel"},
      {{.color = Preset::Color::harmonics, .harmonics_degree = 1}, false, "harmonics of degree 1"},
      {{.color = Preset::Color::base}, false, "base colour"},
      {{.triangle_fraction = 0.25, .keeps_face = {1, 0, 0, 0}}, false, "most visible 25 %"},
      {{.feature_storage = Preset::FeatureStorage::rgba16f}, true, "features as half floats"},
      {{.feature_storage = Preset::FeatureStorage::rgba8}, true, "features as bytes"},
      {{.site = Preset::Site::deferred}, true, "once a pixel"},
      {{.site = Preset::Site::forward}, true, "once a fragment"},
      {{.resolution_scale = 0.75}, true, "75 % of the rows and columns"},
      {{.supersampling = 2}, true, "2 x 2 samples a pixel"},
      {{.alpha_to_coverage = 4}, true, "alpha to coverage of 4 samples"},
  };
  for (const Turned& one : turned) {
    EXPECT_THAT(describe(one.preset), HasSubstr(one.words));
    EXPECT_FALSE(is_faithful(one.preset)) << one.words;
    EXPECT_EQ(keeps_data(one.preset), one.keeps_data) << one.words;
    EXPECT_EQ(defect(one.preset), std::nullopt) << one.words;
  }
  EXPECT_EQ(describe({.lattice_level = 2, .texel_bits = 4}),
            "lattice level at most 2, 4 bits a texel channel");
}

TEST(RenderPreset, WhatIsAskedForCountsMore) {
  using Preset = RenderPreset;
  const Preset own{.lattice_level = 2,
                   .texel_bits = 8,
                   .triangle_fraction = 0.5,
                   .keeps_face = {1, 0},
                   .resolution_scale = 0.5,
                   .promised_psnr_db = 51.0};
  const Preset same = combined(own, {});
  EXPECT_EQ(describe(same), describe(own));
  EXPECT_EQ(same.keeps_face, own.keeps_face);
  EXPECT_EQ(same.promised_psnr_db, 51.0);
  const Preset asked{.lattice_level = 1,
                     .texel_bits = 4,
                     .color = Preset::Color::harmonics,
                     .harmonics_degree = 1,
                     .triangle_fraction = 0.25,
                     .keeps_face = {0, 0, 0, 1},
                     .feature_storage = Preset::FeatureStorage::rgba8,
                     .site = Preset::Site::deferred,
                     .supersampling = 2,
                     .promised_psnr_db = 20.0};
  const Preset both = combined(own, asked);
  EXPECT_EQ(describe(both), describe(asked));
  EXPECT_EQ(both.keeps_face, asked.keeps_face);
  EXPECT_EQ(both.harmonics_degree, 1);
  EXPECT_EQ(both.resolution_scale, 1) << "one knob with supersampling";
  EXPECT_EQ(both.promised_psnr_db, 51.0);
  EXPECT_EQ(combined(own, {.alpha_to_coverage = 4}).alpha_to_coverage, 4);
}

TEST(RenderPreset, WhatCannotBeObeyedIsRefused) {
  using Preset = RenderPreset;
  const auto expect_defect = [](const Preset& preset, const char* reason) {
    EXPECT_THAT(defect(preset).value_or("accepted"), HasSubstr(reason));
  };
  expect_defect({.lattice_level = -1}, "lattice level is -1, not 0 to 7");
  expect_defect({.lattice_level = 8}, "not 0 to 7");
  expect_defect({.texel_bits = 12}, "bits a texel channel is 12");
  expect_defect({.harmonics_degree = 3}, "not 0, 1 or 2");
  expect_defect({.triangle_fraction = 0}, "fraction of triangles is 0");
  expect_defect({.triangle_fraction = NAN}, "fraction of triangles is nan");
  expect_defect({.triangle_fraction = 0.5}, "does not say which");
  expect_defect({.keeps_face = {1}}, "and yet not every one");
  expect_defect({.triangle_fraction = 0.5, .keeps_face = {1, 2}}, "neither");
  expect_defect({.resolution_scale = 0.2}, "resolution scale is 0.2, not 0.25 to 1");
  expect_defect({.supersampling = 9}, "supersampling is 9");
  expect_defect({.alpha_to_coverage = 3}, "0, 2, 4 or 8");
  expect_defect({.promised_psnr_db = -1.0}, "promised PSNR");
  expect_defect({.feature_storage = Preset::FeatureStorage::rgba8, .site = Preset::Site::forward},
                "shades every fragment at once");
  expect_defect({.site = Preset::Site::deferred, .alpha_to_coverage = 2}, "alpha to coverage");
  expect_defect({.resolution_scale = 0.5, .supersampling = 2}, "and for more");

  TriangleSoup soup;
  soup.triangles.resize(3);
  EXPECT_THAT(defect({.triangle_fraction = 0.5, .keeps_face = {1, 0}}, soup).value_or("accepted"),
              HasSubstr("among 2 triangles, and the scene has 3"));
  EXPECT_EQ(defect({.triangle_fraction = 0.5, .keeps_face = {1, 0, 1}}, soup), std::nullopt);
}

}  // namespace
}  // namespace tureen
