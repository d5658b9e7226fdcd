// Timers of the device: the times of passes, the reasons to reject them, and the images of the
// ceilings.
#include "jobs/timing/pass_times.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "camera/navigation.hpp"
#include "jobs/bench/copy_ceiling.hpp"
#include "runtime/gl/timer_query.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/cutout_cloud.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/renderer_of.hpp"

namespace tureen {
namespace pass_times_test {

using test::Names;

gl::Capabilities device(const std::string& renderer, bool software, bool timer_queries) {
  gl::Capabilities capabilities;
  capabilities.renderer = renderer;
  capabilities.software = software;
  capabilities.timer_queries = timer_queries;
  return capabilities;
}

TEST(TimersMislead, OnSoftwareAndWithoutQueries) {
  const auto llvmpipe = gl::timers_mislead(device("llvmpipe (LLVM 15.0.6, 256 bits)", true, true));
  ASSERT_TRUE(llvmpipe);
  EXPECT_THAT(*llvmpipe, Names("llvmpipe"));
  EXPECT_TRUE(gl::timers_mislead(device("a phone", false, false)));
  EXPECT_FALSE(gl::timers_mislead(device("a graphics card", false, true)));
}

TEST(BelievedPasses, AreThoseThatTheWallClockHasRoomFor) {
  const PassTimes good = believed({{"visibility", 1.0}, {"shading", 2.0}}, 3.1);
  EXPECT_EQ(good.gap, PassTimesGap::none);
  EXPECT_EQ(good.reason, "");
  ASSERT_TRUE(good.gpu_ms);
  EXPECT_DOUBLE_EQ(*good.gpu_ms, 3.0);
  ASSERT_EQ(good.ms.size(), 2u);
  EXPECT_EQ(good.ms[1].first, "shading");

  const PassTimes impossible = believed({{"visibility", 1.0}, {"shading", 2.6}}, 3.1);
  EXPECT_EQ(impossible.gap, PassTimesGap::exceeds_wall_clock);
  EXPECT_THAT(impossible.reason, Names("3.600 ms", "3.100 ms"));
  EXPECT_TRUE(impossible.ms.empty());
  EXPECT_FALSE(impossible.gpu_ms);
}

TEST(BelievedPasses, SayWhereTheyAreTheLesserPartOfAFrame) {
  EXPECT_EQ(believed({{"visibility", 0.6}, {"shading", 0.9}}, 3.0).gap, PassTimesGap::none);
  const PassTimes little = believed({{"forward", 0.1}}, 3.0);
  EXPECT_EQ(little.gap, PassTimesGap::partial);
  EXPECT_THAT(little.reason, Names("0.100 ms", "3.000 ms"));
  ASSERT_EQ(little.ms.size(), 1u) << "the processor may be the bottleneck";
  EXPECT_DOUBLE_EQ(little.gpu_ms.value_or(0), 0.1);
}

TEST(BelievedPasses, AreNotThoseOfAClockThatStandsStill) {
  const PassTimes nothing = believed({{"visibility", 0.0}, {"shading", 0.0}}, 3.0);
  EXPECT_EQ(nothing.gap, PassTimesGap::exceeds_wall_clock);
  EXPECT_THAT(nothing.reason, Names("0.000 ms", "3.000 ms"));
  EXPECT_TRUE(nothing.ms.empty());
  EXPECT_FALSE(nothing.gpu_ms);
}

TEST(SoftwareRenderers, AreKnownByTheirNames) {
  for (const char* renderer :
       {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe",
        "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero) (0x0000C0DE)), SwiftShader "
        "driver)",
        "D3D12 (Microsoft Basic Render Driver)", "GDI Generic", "Apple Software Renderer"})
    EXPECT_TRUE(gl::draws_in_software(renderer)) << renderer;
  for (const char* renderer : {"NVIDIA GeForce RTX 4090/PCIe/SSE2", "Apple M2", "Adreno (TM) 740",
                               "D3D12 (Intel(R) UHD Graphics 620)", "unknown"})
    EXPECT_FALSE(gl::draws_in_software(renderer)) << renderer;
}

Scene small_cloud() { return test::cutout_cloud({.triangles = 50, .width = 64, .height = 48}); }

class DeviceTimers : public testing::TestWithParam<test::NamedContext> {};

TEST_P(DeviceTimers, NameEveryPassOfEveryFrame) {
  const gl::Context context = gl::Context::create(GetParam().request);
  if (!context.capabilities().timer_queries) GTEST_SKIP() << "no timer queries here";
  const Scene scene = small_cloud();
  Renderer renderer = renderer_of(context, only_soup(scene), origin_of(only_layer(scene)));
  gl::PassTimer timer(context);
  renderer.draw({scene.cameras[0]});  // before the timer: not counted
  for (int round = 0; round < 2; ++round) {
    renderer.time_passes(&timer);
    for (int i = 0; i < 3; ++i) renderer.draw({scene.cameras[0]});
    renderer.time_passes(nullptr);
    renderer.draw({scene.cameras[0]});
    const auto passes = timer.collect();
    ASSERT_EQ(passes.size(), 2u);
    EXPECT_EQ(passes[0].pass, "visibility");
    EXPECT_EQ(passes[1].pass, "shading");
    EXPECT_EQ(passes[0].turns, 3);
    EXPECT_EQ(passes[1].turns, 3);
    EXPECT_GT(passes[0].ms + passes[1].ms, 0);
  }
  EXPECT_TRUE(timer.collect().empty());
}

TEST_P(DeviceTimers, AreNotUsedWhereTheyMislead) {
  const gl::Context context = gl::Context::create(GetParam().request);
  if (!context.capabilities().software) GTEST_SKIP() << "not a software renderer";
  const Scene scene = small_cloud();
  Renderer renderer = renderer_of(context, only_soup(scene), origin_of(only_layer(scene)));
  const PassTimes times = time_passes(context, renderer, scene.cameras, 2);
  EXPECT_EQ(times.gap, PassTimesGap::no_timers);
  EXPECT_THAT(times.reason, Names(context.capabilities().renderer));
  EXPECT_TRUE(times.ms.empty());
  EXPECT_FALSE(times.gpu_ms);
}

INSTANTIATE_TEST_SUITE_P(Contexts, DeviceTimers, testing::ValuesIn(test::every_context),
                         [](const auto& each) { return each.param.name; });

class Ceilings : public testing::TestWithParam<test::NamedContext> {};

TEST_P(Ceilings, TrianglesWithoutColoursLeaveTheBackground) {
  const gl::Context context = gl::Context::create(GetParam().request);
  const Scene scene = small_cloud();
  Renderer renderer = renderer_of(
      context, only_soup(scene), origin_of(only_layer(scene)),
      {.plan = {.site = ShadingSite::nowhere}, .background = glm::vec4(0.2f, 0.4f, 0.6f, 1.0f)});
  EXPECT_EQ(renderer.plan().soup(0).site, ShadingSite::nowhere);
  renderer.draw({scene.cameras[0]});
  const Image8 image = renderer.read_color();
  EXPECT_THAT(image.pixels, testing::Each(glm::u8vec4(51, 102, 153, 255)));
  EXPECT_TRUE(faces_of(renderer).empty());
}

TEST_P(Ceilings, TheCopyIsAnImagesWorthOfPixels) {
  const gl::Context context = gl::Context::create(GetParam().request);
  CopyCeiling copy(context);
  for (const int width : {64, 200, 37}) {
    copy.draw(width, 48);
    const Image8 image = copy.read_copy();
    ASSERT_EQ(image.width, width);
    ASSERT_EQ(image.height, 48);
    // Row 0 of the image is the top one of 64 rows of cells; green increases upwards.
    EXPECT_GT(image.at(0, 0).g, 240);
    EXPECT_LT(image.at(0, 47).g, 10);
    EXPECT_GT(image.at(width - 1, 0).r, 240);
    EXPECT_LT(image.at(0, 0).r, 10);
  }
}

INSTANTIATE_TEST_SUITE_P(Contexts, Ceilings, testing::ValuesIn(test::every_context),
                         [](const auto& each) { return each.param.name; });

}  // namespace pass_times_test
}  // namespace tureen
