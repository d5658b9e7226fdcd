#include "formats/uri.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

namespace tureen {
namespace {

using ::testing::HasSubstr;

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const UriError& error) {
    return error.reason;
  }
  return "accepted";
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
  EXPECT_THAT(refusal([] { decode_data_uri("data:text/plain,hello"); }),
              HasSubstr("not in base64"));
  EXPECT_THAT(refusal([] { decode_data_uri("data:"); }), HasSubstr("not in base64"));
  EXPECT_THAT(refusal([] { decode_data_uri("data:;base64,Zm9vY"); }), HasSubstr("cut short"));
  EXPECT_THAT(refusal([] { decode_data_uri("data:;base64,Zm!v"); }), HasSubstr("not base64"));
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

  std::string refused(std::string_view uri) {
    return refusal([&] { resolve_in_folder(base_ / "scene", uri); });
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
  EXPECT_THAT(refused("../secret.bin"), HasSubstr("leads out"));
  EXPECT_THAT(refused("textures/../../secret.bin"), HasSubstr("leads out"));
  EXPECT_THAT(refused("%2e%2e/secret.bin"), HasSubstr("leads out"));
  EXPECT_THAT(refused("..%2Fsecret.bin"), HasSubstr("leads out"));
  EXPECT_THAT(refused("..\\secret.bin"), HasSubstr("leads out"));
  EXPECT_THAT(refused("/etc/passwd"), HasSubstr("absolute"));
  EXPECT_THAT(refused("%2Fetc/passwd"), HasSubstr("absolute"));
  EXPECT_THAT(refused("\\\\server\\share"), HasSubstr("absolute"));
  EXPECT_THAT(refused("file:///etc/passwd"), HasSubstr("not a file in the scene's folder"));
  EXPECT_THAT(refused("https://example.org/x.bin"), HasSubstr("not a file"));
  EXPECT_THAT(refused("C:/x.bin"), HasSubstr("not a file"));
  EXPECT_THAT(refused("link.bin"), HasSubstr("link that leads out"));
  EXPECT_THAT(refused("up/secret.bin"), HasSubstr("link that leads out"));
  EXPECT_THAT(refused("a%00.bin"), HasSubstr("zero byte"));
  EXPECT_THAT(refused(""), HasSubstr("names no file"));
}

}  // namespace
}  // namespace tureen
