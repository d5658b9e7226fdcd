// Which photographs are read, which pairs of them are matched, and which frames of a video are
// taken.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include "base/error.hpp"
#include "base/output.hpp"
#include "image/png.hpp"
#include "image/video_file.hpp"
#include "jobs/cameras/photo_neighbors.hpp"
#include "jobs/cameras/photo_set.hpp"
#include "jobs/cameras/video_frames.hpp"

namespace tureen {
namespace photo_choice_test {

namespace fs = std::filesystem;

const auto no_progress = [](double) {};

class InFolder : public testing::Test {
 protected:
  void SetUp() override {
    folder =
        fs::path(testing::TempDir()) /
        (std::string("tureen_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder);
    fs::create_directories(folder);
  }
  void TearDown() override { fs::remove_all(folder); }
  fs::path folder;
};
using PhotoSets = InFolder;
using VideoFrames = InFolder;

TEST(NaturalOrder, ComparesNumbersAsNumbers) {
  std::vector<std::string> names{"b1", "a10", "a2", "a", "a02", "a1b", "10", "9"};
  std::sort(names.begin(), names.end(), natural_less);
  EXPECT_THAT(names, testing::ElementsAre("9", "10", "a", "a1b", "a02", "a2", "a10", "b1"));
}

TEST_F(PhotoSets, LeaveOutWhatIsNoPhotograph) {
  const auto add = [&](const std::string& name, int width) {
    write_file(folder / name, encode_png(Image8(width, 3, glm::u8vec4(9))));
  };
  add("a 10.png", 5);
  add("a 2.png", 5 + 1);
  add("copy.PNG", 5);
  write_file(folder / "broken.jpg", "no image");
  write_file(folder / "phone.heic", std::string("\0\0\0\x18"
                                                "ftypheic",
                                                12));
  write_file(folder / "notes.txt", "text");
  const PhotoSet set = find_photographs(folder, no_progress);
  ASSERT_EQ(set.photos.size(), 2u);
  EXPECT_EQ(set.photos[0].name, "a_2.png");
  EXPECT_EQ(set.photos[1].name, "a_10.png");
  EXPECT_EQ(set.photos[1].size, glm::ivec2(5, 3));
  EXPECT_EQ(camera_groups(set).size(), 2u);
  std::vector<std::string> remarks;
  for (const Remark& remark : set.remarks) remarks.push_back(describe(remark));
  EXPECT_THAT(remarks,
              testing::ElementsAre(testing::HasSubstr("broken.jpg"), testing::HasSubstr("HEIC"),
                                   testing::HasSubstr("copy.PNG")));
  EXPECT_THROW(find_photographs(folder / "none", no_progress), InputError);
}

/// Photographs 0 .. count - 1 in a row; each shows 40 things, and shares all but 4 with the next.
std::vector<std::vector<FeatureDescriptor>> a_row(std::size_t count) {
  std::mt19937 random(5);
  std::vector<FeatureDescriptor> things(40 + 4 * count);
  for (FeatureDescriptor& thing : things)
    for (std::uint8_t& value : thing) value = std::uint8_t(random() % 200);
  std::vector<std::vector<FeatureDescriptor>> photos(count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 40; ++k) {
      photos[i].push_back(things[4 * i + k]);
      for (std::uint8_t& value : photos[i].back()) value = std::uint8_t(value + random() % 8);
    }
  return photos;
}

TEST(PhotoNeighbors, AreThoseThatShowTheSameThings) {
  const auto row = a_row(60);
  const PhotoNeighbors neighbors = photo_neighbors(row, no_progress);
  EXPECT_TRUE(is_series(neighbors));
  std::size_t right = 0;
  for (std::size_t i = 2; i + 2 < row.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) right += std::abs(int(neighbors[i][k]) - int(i)) <= 4;
  EXPECT_GE(right, 56u * 4 * 9 / 10);  // words are not things: some are shared by chance
  // The same in another order is no series, and has the same neighbours.
  std::vector<std::size_t> order(row.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = 7 * i % 60;
  auto shuffled = row;
  for (std::size_t i = 0; i < order.size(); ++i) shuffled[i] = row[order[i]];
  EXPECT_FALSE(is_series(photo_neighbors(shuffled, no_progress)));
  EXPECT_NO_THROW(photo_neighbors({{}, {}}, no_progress));  // photographs of a blank wall
}

TEST(PhotoPairs, OfASeriesHaveItsOffsetsAndOthersMoreNeighbors) {
  EXPECT_EQ(all_pairs(4).size(), 6u);
  PhotoNeighbors row(100), random(100);
  for (std::size_t i = 0; i < 100; ++i)
    for (std::size_t k = 1; k < 100; ++k) {
      row[i].push_back(k % 2 ? (i + (k + 1) / 2) % 100 : (i + 100 - k / 2) % 100);
      random[i].push_back((i + 37 * k) % 100);
    }
  const PhotoPairs series = likely_pairs(row, 5), others = likely_pairs(random, 5);
  for (const std::size_t offset : {1, 9, 16, 32, 64})
    EXPECT_THAT(series, testing::Contains(std::pair(std::size_t(3), 3 + offset)));
  EXPECT_THAT(series, testing::Contains(std::pair(std::size_t(0), std::size_t(99))));  // a loop
  EXPECT_TRUE(std::is_sorted(series.begin(), series.end()));
  EXPECT_THAT(others, testing::Not(testing::Contains(std::pair(std::size_t(3), std::size_t(4)))));
  EXPECT_GE(others.size(), 100u * 15 / 2);
}

/// A frame of stripes 32 pixels wide, moved to the left; from black to white within 2 * `soft`
/// pixels.
std::vector<std::uint8_t> stripes(int shift, int soft) {
  std::vector<std::uint8_t> frame(std::size_t(video_frame_side) * video_frame_side);
  for (int y = 0; y < video_frame_side; ++y)
    for (int x = 0; x < video_frame_side; ++x) {
      const int phase = (x + shift) % 64, edge = std::min(phase, 64 - phase);
      frame[std::size_t(y * video_frame_side + x)] =
          std::uint8_t(std::clamp(128 + 127 * (edge - 16) / soft, 0, 255));
    }
  return frame;
}

TEST(FrameMeter, SharpFramesHaveMoreSharpnessAndMovedOnesMotion) {
  FrameMeter meter;
  const FrameFacts sharp = meter.measure(stripes(0, 1)), blurred = meter.measure(stripes(0, 8)),
                   still = meter.measure(stripes(0, 8)), moved = meter.measure(stripes(30, 8));
  EXPECT_GT(sharp.sharpness, 4 * blurred.sharpness);
  EXPECT_EQ(sharp.motion, 0);  // there is none before
  EXPECT_EQ(still.motion, 0);
  EXPECT_GT(moved.motion, 50);
}

TEST(ChosenFrames, AreTheSharpestOfEachIntervalAndMoreWhereItMoves) {
  // 100 seconds; every third frame is sharp; the second half moves.
  std::vector<FrameFacts> frames(300);
  for (std::size_t i = 0; i < 300; ++i)
    frames[i] = {.sharpness = i % 3 == 1 ? 100.0 : 10.0, .motion = i < 150 ? 0.0 : 10.0};
  const auto chosen = chosen_frames(frames, 20);
  EXPECT_GE(chosen.size(), 40u);
  EXPECT_LE(chosen.size(), 200u);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  const auto later = std::count_if(chosen.begin(), chosen.end(), [](auto i) { return i >= 150; });
  EXPECT_GT(later, std::ptrdiff_t(chosen.size()) / 2);
  const auto quiet =
      std::count_if(chosen.begin(), chosen.end(), [](auto i) { return i < 150 && i % 3 == 1; });
  EXPECT_GE(quiet, std::ptrdiff_t(chosen.size()) - later - 1);  // all but one on the border
  EXPECT_THAT(chosen_frames(std::span(frames).first(10), 1), testing::SizeIs(10));
  EXPECT_THAT(chosen_frames({}, 1), testing::IsEmpty());
}

TEST_F(VideoFrames, AreTakenFromAVideo) {
  if (!have_ffmpeg()) GTEST_SKIP() << "videos need ffmpeg";
  {
    VideoFile video(folder / "a %d video.mp4", {.width = 96, .height = 64, .frames_per_second = 4});
    for (int i = 0; i < 300; ++i) {
      Image8 frame(96, 64, glm::u8vec4(0, 0, 0, 255));
      for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x)  // every third frame has more contrast
          frame.at(x, y) = glm::u8vec4(glm::u8vec3(((x + i) / 8 % 2) * (i % 3 ? 60 : 200)), 255);
      video.add(frame);
    }
    video.commit();
  }
  fs::create_directories(folder / "50% frames");
  double last = 0;
  take_video_frames(folder / "a %d video.mp4", folder / "50% frames", [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  });
  const PhotoSet set = find_photographs(folder / "50% frames", no_progress);
  const auto taken = std::distance(fs::directory_iterator(folder / "50% frames"), {});
  EXPECT_GE(taken, 120);  // of 75 seconds; more than a sum in ffmpeg's language may have
  EXPECT_EQ(set.photos[0].name, "00001.jpg");
  EXPECT_EQ(set.photos[0].size, glm::ivec2(96, 64));
  write_file(folder / "no.mp4", "no video");
  EXPECT_THROW(take_video_frames(folder / "no.mp4", folder, no_progress), InputError);
}

}  // namespace photo_choice_test
}  // namespace tureen
