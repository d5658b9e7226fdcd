#include "image/stored_image.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "base/error.hpp"
#include "base/platform/scratch_file.hpp"
#include "tests/support/random.hpp"

namespace tureen {
namespace stored_image_test {

Image8 random_image(int width, int height, bool is_opaque) {
  test::Random random(5);
  Image8 image(width, height);
  const auto byte = [&] { return std::uint8_t(random.uniform() * 255.99); };
  for (glm::u8vec4& pixel : image.pixels)
    pixel = {byte(), byte(), byte(), is_opaque ? std::uint8_t(255) : byte()};
  return image;
}

TEST(StoredImage, IsTheSameFromAFile) {
  const auto file = std::make_shared<ScratchFile>();
  for (const bool is_opaque : {true, false}) {
    const Image8 image = random_image(37, 19, is_opaque);
    StoredImage stored = image;
    const StoredImage in_memory = stored;
    EXPECT_EQ(stored.is_opaque(), is_opaque);
    EXPECT_TRUE(stored.planes().empty());
    const std::uint64_t before = file->size();
    stored.move_to(file);
    stored.move_to(file);  // nothing more to do
    EXPECT_EQ(file->size() - before, 37u * 19u * (is_opaque ? 3u : 4u));
    EXPECT_EQ(stored.planes().file(), file);
    EXPECT_EQ(stored.is_opaque(), is_opaque);
    for (const StoredImage& each : {stored, in_memory}) {
      const Image8 read = each();
      EXPECT_EQ(read.width, 37);
      EXPECT_EQ(read.height, 19);
      EXPECT_EQ(read.pixels, image.pixels);
    }
  }
}

TEST(StoredImage, LosesAlphaWithoutAWrite) {
  const Image8 image = random_image(37, 19, false);
  Image8 opaque = image;
  for (glm::u8vec4& pixel : opaque.pixels) pixel.a = 255;
  const auto file = std::make_shared<ScratchFile>();
  for (const bool in_file : {false, true}) {
    StoredImage stored = image;
    if (in_file) stored.move_to(file);
    const StoredImage copy = stored;
    const std::uint64_t before = file->size();
    stored.remove_alpha();
    EXPECT_EQ(file->size(), before);
    EXPECT_TRUE(stored.is_opaque());
    EXPECT_EQ(stored().pixels, opaque.pixels);
    EXPECT_EQ(copy().pixels, image.pixels) << "copies keep theirs";
  }
}

TEST(StoredImage, MayBeEmpty) {
  EXPECT_TRUE(StoredImage()().pixels.empty());
  EXPECT_TRUE(StoredBytes()().empty());
  StoredBytes bytes;
  bytes.move_to(std::make_shared<ScratchFile>());
  EXPECT_EQ(bytes.file(), nullptr);
}

/// Sets TMPDIR while it exists.
class ScratchFolder {
 public:
  explicit ScratchFolder(const char* folder) { setenv("TMPDIR", folder, 1); }
  ~ScratchFolder() { before_.empty() ? unsetenv("TMPDIR") : setenv("TMPDIR", before_.c_str(), 1); }

 private:
  std::string before_ = std::getenv("TMPDIR") ? std::getenv("TMPDIR") : "";
};

TEST(ScratchFile, LeavesNoNameInItsFolder) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "tureen_scratch_file";
  std::filesystem::create_directories(folder);
  const ScratchFolder chosen(folder.c_str());
  StoredBytes bytes(std::vector<std::uint8_t>{1, 2, 3});
  bytes.move_to(std::make_shared<ScratchFile>());
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  EXPECT_EQ(bytes(), (std::vector<std::uint8_t>{1, 2, 3}));
  std::filesystem::remove(folder);
}

TEST(ScratchFile, NeedsAFolder) {
  const ScratchFolder chosen("/nonexistent/folder");
  try {
    const ScratchFile file;
    ADD_FAILURE() << "no error";
  } catch (const OutputError& error) {
    EXPECT_EQ(error.position().file, "/nonexistent/folder");
    EXPECT_NE(error.hint().find("TMPDIR"), std::string::npos);
  }
}

TEST(ScratchFile, ReportsAFullDiskAndLeavesNoFile) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "tureen_full_disk";
  std::filesystem::create_directories(folder);
  const ScratchFolder chosen(folder.c_str());
  // No file may have more than 1,000 bytes.
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  rlimit usual{};
  getrlimit(RLIMIT_FSIZE, &usual);
  const rlimit small{1000, usual.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  {
    const auto file = std::make_shared<ScratchFile>();
    StoredBytes fits(std::vector<std::uint8_t>(900, 7)), large(std::vector<std::uint8_t>(900, 8));
    fits.move_to(file);
    EXPECT_THROW(large.move_to(file), OutputError);
    EXPECT_EQ(fits(), std::vector<std::uint8_t>(900, 7));
    EXPECT_EQ(large(), std::vector<std::uint8_t>(900, 8)) << "nothing is lost";
    EXPECT_TRUE(std::filesystem::is_empty(folder));
  }
  setrlimit(RLIMIT_FSIZE, &usual);
  std::signal(SIGXFSZ, before);
  EXPECT_TRUE(std::filesystem::remove(folder)) << "it is empty";
}

}  // namespace stored_image_test
}  // namespace tureen
