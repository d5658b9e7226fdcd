#include "scene/remark.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "scene/scene.hpp"

namespace tureen {
namespace remark_test {

using Kind = Remark::Kind;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Remark, EveryKindHasANameOfItsOwnAndASentence) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < Remark::kinds; ++i) {
    // More values than any kind needs.
    const Remark remark{Kind(i), {1, 2, 3}, {0.25, 0.5}, {"a", "b"}};
    EXPECT_TRUE(names.insert(name_of(remark.kind)).second) << name_of(remark.kind);
    EXPECT_FALSE(describe(remark).empty()) << name_of(remark.kind);
  }
  EXPECT_STREQ(name_of(Kind::lens_undone), "lens_undone");
}

TEST(Remark, InEnglish) {
  EXPECT_EQ(describe({Kind::polygons_split, {1}}),
            "1 polygon with more than three corners split into triangles.");
  EXPECT_EQ(describe({Kind::shapes_missing, {0, 1, 4, 5}}),
            "shapes 0, 1 and 4 of 5 missing: the others are drawn");
  EXPECT_EQ(describe({Kind::soft_triangles_dropped, {2, 7}, {0.01}}),
            "2 of 7 soft triangles have an opacity below 0.01: dropped");
  EXPECT_EQ(describe({Kind::soft_triangles_opaque, {}, {0.333, 0.5}}),
            "soft triangles are drawn opaque: on average, a soft triangle covers 33% of its area "
            "(opacity 0.50), the opaque face covers all of it");
  EXPECT_EQ(describe({Kind::splats_dropped, {2, 7}}),
            "2 of 7 splats have a value that is not finite or outside its range: dropped");
  EXPECT_EQ(describe({Kind::splats_dropped, {1, 7}}),
            "1 of 7 splats has a value that is not finite or outside its range: dropped");
  EXPECT_EQ(describe({.kind = Kind::splat_colors_linear}),
            "the splats were trained and are blended in linear light; they are drawn as if their "
            "colours were display-referred, and look different");
  EXPECT_EQ(
      described({{.kind = Kind::octagon_q_assumed, .values = {4}}})[0],
      "the file does not store the radius of its octagons, sqrt(Q) standard deviations: Q = 4 "
      "is assumed; --octagon-q changes it");
  EXPECT_EQ(describe({.kind = Kind::splat_extensions_ignored, .names = {"0xADBE0002", "0x1"}}),
            "extensions of the file that are not supported are ignored: 0xADBE0002, 0x1");
  EXPECT_EQ(describe({Kind::lens_undone, {0, 0}}), "Lens distortion was removed by resampling.");
  EXPECT_EQ(describe({Kind::fisheye_undone, {}, {104.6}}),
            "Fisheye photographs were resampled to pinhole images, at most 105 degrees wide; their "
            "borders were cropped.");
  EXPECT_EQ(describe({Kind::pixels_masked, {2, 7}}), "Masks exclude pixels of 2 of 7 photographs.");
}

TEST(Remark, NotesOfAFileStandBeforeRemarksOnIt) {
  SceneInfo info;
  info.notes = {"a note; --not an option"};
  info.remarks = {{.kind = Kind::up_unknown_to_format, .names = {"OFF"}}};
  EXPECT_THAT(all_notes(info), ElementsAre("a note; --not an option",
                                           "OFF stores no up axis: z is assumed; --up changes it"));
  EXPECT_EQ(describe(info.remarks[0]), "OFF stores no up axis: z is assumed");
}

TEST(Remark, EveryAssumedUpAxisHasTheHintHowToChangeIt) {
  for (const Kind kind : {Kind::up_unknown_to_trimesh, Kind::up_unknown_to_checkpoint,
                          Kind::up_unknown_to_format, Kind::up_unknown_to_splats}) {
    SceneInfo info;
    info.remarks = {{.kind = kind, .names = {"OFF"}}};
    EXPECT_THAT(all_notes(info), ElementsAre(HasSubstr("--up changes it")));
  }
}

}  // namespace remark_test
}  // namespace tureen
