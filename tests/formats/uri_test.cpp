#include "formats/common/uri.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "tests/support/errors.hpp"

namespace tureen {
namespace uri_test {

using test::Names;

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(Uri, DecodesBase64OfEveryLength) {
  EXPECT_EQ(text_of(*decode_data_uri("data:application/octet-stream;base64,")), "");
  EXPECT_EQ(text_of(*decode_data_uri("data:;base64,Zg==")), "f");
  EXPECT_EQ(text_of(*decode_data_uri("data:;base64,Zm8=")), "fo");
  EXPECT_EQ(text_of(*decode_data_uri("data:image/png;base64,Zm9v")), "foo");
  EXPECT_EQ(text_of(*decode_data_uri("data:;base64,Zm9vYg")), "foob");
  EXPECT_EQ(text_of(*decode_data_uri("data:;base64,-_-_")), "\xfb\xff\xbf");
  EXPECT_FALSE(decode_data_uri("shape.bin"));
}

TEST(Uri, RefusesDamagedDataUris) {
  for (const char* uri :
       {"data:text/plain,hello", "data:", "data:;base64,Zm9vY", "data:;base64,Zm!v"})
    EXPECT_THROW(decode_data_uri(uri), UriError) << uri;
}

class ConfinedUri : public ::testing::Test {
 protected:
  void SetUp() override {
    base_ = std::filesystem::path(::testing::TempDir()) / "tureen_uri_test";
    std::filesystem::remove_all(base_);
    std::filesystem::create_directories(base_ / "scene" / "textures");
    std::ofstream(base_ / "secret.bin") << "secret";
    std::ofstream(base_ / "scene" / "a b.bin") << "ok";
    std::ofstream(base_ / "scene" / "textures" / "t.png") << "ok";
    std::filesystem::create_symlink(base_ / "secret.bin", base_ / "scene" / "link.bin");
    std::filesystem::create_directory_symlink(base_, base_ / "scene" / "up");
    std::filesystem::create_symlink("textures/t.png", base_ / "scene" / "inside.png");
  }
  void TearDown() override { std::filesystem::remove_all(base_); }

  /// The error from resolving `uri`.
  std::string refused(std::string_view uri) {
    try {
      resolve_in_folder(base_ / "scene", uri);
    } catch (const UriError& error) {
      return error.reason;
    }
    return "";
  }
  std::filesystem::path base_;
};

TEST_F(ConfinedUri, FindsFilesInTheFolderAndBelow) {
  const auto scene = base_ / "scene";
  for (const char* uri : {"a%20b.bin", "a b.bin", "textures/t.png", "./textures/t.png"})
    EXPECT_TRUE(std::filesystem::exists(resolve_in_folder(scene, uri))) << uri;
  EXPECT_EQ(resolve_in_folder(scene, "inside.png").filename(), "t.png");
  EXPECT_NO_THROW(resolve_in_folder(scene, "missing.bin"));
  EXPECT_NO_THROW(resolve_in_folder(scene, "100%.bin"));
}

TEST_F(ConfinedUri, RefusesWhatLeadsOut) {
  for (const char* name : {"../secret.bin", "textures/../../secret.bin", "..\\secret.bin",
                           "/etc/passwd", "\\\\server\\share", "file:///etc/passwd",
                           "https://example.org/x.bin", "C:/x.bin", "link.bin", "up/secret.bin"})
    EXPECT_THAT(refused(name), Names(name));
  EXPECT_THAT(refused("%2e%2e/secret.bin"), Names("../secret.bin"));
  EXPECT_THAT(refused("..%2Fsecret.bin"), Names("../secret.bin"));
  EXPECT_THAT(refused("%2Fetc/passwd"), Names("/etc/passwd"));
  EXPECT_NE(refused("a%00.bin"), "");
  EXPECT_NE(refused(""), "");
}

}  // namespace uri_test
}  // namespace tureen
