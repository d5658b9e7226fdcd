#include "image/video_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>

#include "base/error.hpp"
#include "tests/formats/format_testing.hpp"

namespace tureen {
namespace video_file_test {

using test::error_of;
using test::ErrorAt;
namespace fs = std::filesystem;

/// Sets PATH for its lifetime.
class Path {
 public:
  explicit Path(const std::string& folders) : before_(std::getenv("PATH")) {
    setenv("PATH", folders.c_str(), 1);
  }
  Path(const Path&) = delete;
  Path& operator=(const Path&) = delete;
  ~Path() { setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

void write_text(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

/// Writes a program with these lines of shell.
void write_program(const fs::path& path, const std::string& lines) {
  write_text(path, "#!/bin/sh\n" + lines + "\n");
  fs::permissions(path, fs::perms::owner_all);
}

/// A colour in each quarter, lighter with each frame. Smooth images suit video codecs.
Image8 frame(int width, int height, int number) {
  Image8 image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      image.at(x, y) = {x < width / 2 ? 200 : 40, y < height / 2 ? 180 : 60, 30 + 20 * number, 255};
  return image;
}

struct Decoded {
  std::vector<std::uint8_t> rgb;
  std::string description;  // codec,width,height,pix_fmt,color_space,r_frame_rate
};

std::string output_of(const std::string& command) {
  std::string text;
  if (std::FILE* pipe = popen(command.c_str(), "r")) {
    char buffer[65536];
    for (std::size_t got; (got = fread(buffer, 1, sizeof buffer, pipe)) > 0;)
      text.append(buffer, got);
    pclose(pipe);
  }
  return text;
}

Decoded decode(const fs::path& path) {
  Decoded result;
  const std::string name = "'file:" + path.string() + "'";
  // The reader needs the matrix of the file, because ffmpeg's default is another one.
  const std::string rgb = output_of("ffmpeg -nostdin -v error -i " + name +
                                    " -vf scale=in_color_matrix=bt709:in_range=tv -f rawvideo "
                                    "-pix_fmt rgb24 -");
  result.rgb.assign(rgb.begin(), rgb.end());
  result.description = output_of(
      "ffprobe -v error -select_streams v -show_entries "
      "stream=codec_name,width,height,pix_fmt,color_space,r_frame_rate -of csv=p=0 " +
      name);
  return result;
}

std::size_t files_in(const fs::path& folder) {
  return std::size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

class Video : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!have_ffmpeg()) GTEST_SKIP() << ffmpeg_missing;
  }
  test::TemporaryFolder folder;
};

TEST_F(Video, ShowsTheFramesThatWereWritten) {
  for (const char* name : {"-a video: 1.mp4", "video.WebM"}) {
    constexpr int width = 65, height = 47, count = 5;
    VideoFile video(folder / name, {width, height, 25});
    for (int i = 0; i < count; ++i) video.add(frame(width, height, i));
    EXPECT_FALSE(fs::exists(folder / name)) << "the file appears only when it is complete";
    video.commit();
    const Decoded decoded = decode(folder / name);
    const bool webm = std::string(name) == "video.WebM";
    EXPECT_EQ(decoded.description,
              (webm ? "vp9" : "h264") + std::string(",66,48,yuv420p,bt709,25/1\n"));
    ASSERT_EQ(decoded.rgb.size(), std::size_t(3) * 66 * 48 * count);
    // The middle of each quarter in each frame, because colours mix near the edges. The tolerance
    // is 4 steps of 8 bits: the range of 219 levels, the matrix and the coding each cost about one.
    for (int i = 0; i < count; ++i) {
      const Image8 expected = frame(width, height, i);
      for (const auto& [x, y] : {std::pair(12, 10), {50, 10}, {12, 36}, {50, 36}})
        for (int channel = 0; channel < 3; ++channel)
          EXPECT_NEAR(
              decoded.rgb[std::size_t(3) * (std::size_t(i) * 66 * 48 + y * 66 + x) + channel],
              expected.at(x, y)[channel], 4)
              << name << " frame " << i;
    }
  }
  EXPECT_EQ(files_in(folder / ""), 2u);
}

TEST_F(Video, ThatIsNotFinishedLeavesNothingAndKeepsTheOldOne) {
  write_text(folder / "video.mp4", "old");
  {
    VideoFile video(folder / "video.mp4", {64, 48, 30});
    for (int i = 0; i < 3; ++i) video.add(frame(64, 48, i));
  }
  EXPECT_EQ(files_in(folder / ""), 1u);
  std::ifstream stream(folder / "video.mp4");
  std::string text;
  stream >> text;
  EXPECT_EQ(text, "old");
}

TEST(VideoFile, TellsWhatFfmpegComplainsAbout) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "bin");
  write_program(folder / "bin/ffmpeg", "echo 'Unknown encoder' >&2\nexit 1");
  const Path path((folder / "bin").string() + ":/usr/bin:/bin");
  const auto failure = [&] {
    return error_of<OutputError>([&] {
      VideoFile video(folder / "video.mp4", {64, 48, 30});
      // Some frames fit into the buffer of the connection before writing fails.
      for (int i = 0; i < 200; ++i) video.add(frame(64, 48, 1));
      video.commit();
    });
  };
  EXPECT_THAT(failure(), ErrorAt("video.mp4", "ffmpeg", "Unknown encoder"));
  // A program that ends by a signal, without a message.
  write_program(folder / "bin/ffmpeg", "kill -9 $$");
  EXPECT_THAT(failure(), ErrorAt("video.mp4", "ffmpeg"));
  EXPECT_EQ(files_in(folder / ""), 1u) << "only bin";
}

TEST(VideoFile, IsRefusedWithAdviceWhereFfmpegIsMissing) {
  const test::TemporaryFolder folder;
  const Path path((folder / "").string());
  EXPECT_FALSE(have_ffmpeg());
  try {
    VideoFile video(folder / "video.mp4", {64, 48, 30});
    FAIL() << "no exception";
  } catch (const UsageError& error) {
    EXPECT_EQ(error.reason(), ffmpeg_missing);
    EXPECT_EQ(error.hint(), ffmpeg_hint);
  }
}

TEST(VideoFile, NamesAndFoldersAreLookedAtFirst) {
  EXPECT_TRUE(is_video_name("a.mp4"));
  EXPECT_TRUE(is_video_name("a.b/c.WEBM"));
  EXPECT_FALSE(is_video_name("frame_%04d.png"));
  EXPECT_FALSE(is_video_name("mp4"));
  EXPECT_THROW(VideoFile("video.avi", {64, 48, 30}), UsageError);
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "bin");
  write_program(folder / "bin/ffmpeg", "cat");
  const Path path((folder / "bin").string() + ":/usr/bin:/bin");
  EXPECT_THROW(VideoFile(folder / "none/video.mp4", {64, 48, 30}), OutputError);
}

}  // namespace video_file_test
}  // namespace tureen
