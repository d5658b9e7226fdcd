#include "scene/remark.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/scene.hpp"
#include "scene/scene_remarks.hpp"

namespace tureen {
namespace remark_test {

using testing::ElementsAre;

TEST(Remark, IsEqualByItsFields) {
  const Remark remark{&remarks::splats_limited, {{"kept", 2u}, {"all", 7u}}};
  EXPECT_EQ(describe(remark), "2 of 7 splats were read: those with the largest opacity times area");
  EXPECT_NE(remark, (Remark{&remarks::splats_limited, {{"kept", 2u}, {"all", 8u}}}));
}

TEST(Remark, HasWordsByCount) {
  constexpr RemarkKind kind{"kind", RemarkKind::Severity::note, "{n} {n:face|faces}: {list:and}"};
  using Counts = std::vector<std::uint64_t>;
  EXPECT_EQ(describe({&kind, {{"n", 1}, {"list", Counts{4}}}}), "1 face: 4");
  EXPECT_EQ(describe({&kind, {{"n", 0}, {"list", Counts{4, 5}}}}), "0 faces: 4 and 5");
  EXPECT_EQ(describe({&kind, {{"n", 1234}, {"list", Counts{4, 5, 6}}}}), "1234 faces: 4, 5 and 6");
}

TEST(Remark, HasWordsForListsOfOneName) {
  constexpr RemarkKind kind{"kind", RemarkKind::Severity::note, "{names:and} {names:is|are} blue"};
  using Names = std::vector<std::string>;
  EXPECT_EQ(describe({&kind, {{"names", Names{"a"}}}}), "a is blue");
  EXPECT_EQ(describe({&kind, {{"names", Names{"a", "b"}}}}), "a and b are blue");
}

TEST(Remark, KeepsTheBracesOfAFieldThatItLacks) {
  constexpr RemarkKind kind{"kind", RemarkKind::Severity::note, "{m} and {n:.2}"};
  EXPECT_EQ(describe({&kind, {{"n", 0.125}}}), "{m} and 0.12");
}

TEST(Remark, KeepsABraceThatNothingCloses) {
  constexpr RemarkKind kind{"kind", RemarkKind::Severity::note, "{n:.} of {all"};
  EXPECT_EQ(describe({&kind, {{"n", 2u}, {"all", 3u}}}), "2 of {all");
}

TEST(Remark, RoundsNumbers) {
  EXPECT_EQ(describe({&remarks::soft_triangles_dropped,
                      {{"dropped", 2u}, {"all", 7u}, {"smallest_opacity", 0.01}}}),
            "2 of 7 soft triangles have an opacity below 0.01: dropped");
  EXPECT_EQ(describe({&remarks::soft_triangles_opaque, {{"coverage", 0.333}, {"opacity", 0.5}}}),
            "soft triangles are drawn opaque: on average, a soft triangle covers 33% of its area "
            "(opacity 0.50), the opaque face covers all of it");
}

TEST(Remark, ListsTexts) {
  const Remark remark{&remarks::settings_dropped,
                      {{"settings", std::vector<std::string>{"cameras", "up axis"}}},
                      "second"};
  EXPECT_EQ(describe(remark),
            "second: these settings differ from those of the first scene and are ignored: cameras, "
            "up axis");
}

TEST(Remark, NotesOfAFileStandBeforeRemarksOnIt) {
  SceneInfo info;
  info.notes = {"a note"};
  info.remarks = {{&remarks::screen_interpolation_dropped}};
  EXPECT_THAT(all_notes(info), ElementsAre("a note", describe(info.remarks[0])));
}

TEST(Remark, LeavesWithTheAssumptionThatAChoiceReplaces) {
  constexpr RemarkKind assumed{"up_assumed", RemarkKind::Severity::assumption, "z is assumed",
                               "up"};
  SceneInfo info;
  info.remarks = {{&assumed}, {&remarks::screen_interpolation_dropped}};
  choose_up(info, {0, 1, 0});
  EXPECT_THAT(info.remarks, ElementsAre(Remark{&remarks::screen_interpolation_dropped}));
}

}  // namespace remark_test
}  // namespace tureen
