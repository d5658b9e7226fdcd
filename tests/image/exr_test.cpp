// A reader of the written subset of OpenEXR finds what was written.
#include "image/exr.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

namespace tureen {
namespace exr_test {

class Reader {
 public:
  explicit Reader(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}
  template <class T>
  T get() {
    T value{};
    EXPECT_LE(at + sizeof value, bytes_.size());
    if (at + sizeof value <= bytes_.size()) std::memcpy(&value, &bytes_[at], sizeof value);
    at += sizeof value;
    return value;
  }
  std::string name() {
    std::string text;
    while (const char c = get<char>()) text += c;
    return text;
  }
  std::size_t size() const { return bytes_.size(); }
  std::size_t at = 0;

 private:
  std::vector<std::byte> bytes_;
};

TEST(Exr, HoldsItsChannelsInAlphabeticalOrder) {
  const std::vector<float> r = {1, 2, 3, 4, 5, 6}, g = {-1, 0, 1e30f, 0.5f, 1e-30f, 7};
  std::vector<float> b(6, std::numeric_limits<float>::infinity());
  Reader file(encode_exr(3, 2, {{"R", r}, {"G", g}, {"B", b}}));
  EXPECT_EQ(file.get<std::int32_t>(), 20000630);
  EXPECT_EQ(file.get<std::int32_t>(), 2);
  std::vector<std::string> channels;
  std::map<std::string, std::string> types;
  for (std::string name = file.name(); !name.empty(); name = file.name()) {
    types[name] = file.name();
    const auto end = file.at + std::size_t(file.get<std::int32_t>()) + 4;
    if (name == "channels")
      for (std::string one = file.name(); !one.empty(); one = file.name()) {
        channels.push_back(one);
        EXPECT_EQ(file.get<std::int32_t>(), 2) << "32-bit floats";
        file.at += 4;
        EXPECT_EQ(file.get<std::int32_t>(), 1);
        EXPECT_EQ(file.get<std::int32_t>(), 1);
      }
    if (name == "dataWindow" || name == "displayWindow") {
      EXPECT_EQ(file.get<std::int32_t>(), 0);
      EXPECT_EQ(file.get<std::int32_t>(), 0);
      EXPECT_EQ(file.get<std::int32_t>(), 2);
      EXPECT_EQ(file.get<std::int32_t>(), 1);
    }
    if (name == "compression" || name == "lineOrder") {
      EXPECT_EQ(file.get<std::uint8_t>(), 0);
    }
    if (name == "pixelAspectRatio" || name == "screenWindowWidth") {
      EXPECT_EQ(file.get<float>(), 1.0f);
    }
    if (name == "screenWindowCenter") file.at += 8;
    EXPECT_EQ(file.at, end) << name;
  }
  EXPECT_EQ(channels, (std::vector<std::string>{"B", "G", "R"}));
  // The eight attributes that the format requires.
  EXPECT_EQ(types, (std::map<std::string, std::string>{{"channels", "chlist"},
                                                       {"compression", "compression"},
                                                       {"dataWindow", "box2i"},
                                                       {"displayWindow", "box2i"},
                                                       {"lineOrder", "lineOrder"},
                                                       {"pixelAspectRatio", "float"},
                                                       {"screenWindowCenter", "v2f"},
                                                       {"screenWindowWidth", "float"}}));
  const std::uint64_t rows[2] = {file.get<std::uint64_t>(), file.get<std::uint64_t>()};
  for (int y = 0; y < 2; ++y) {
    EXPECT_EQ(file.at, rows[y]);
    EXPECT_EQ(file.get<std::int32_t>(), y);
    EXPECT_EQ(file.get<std::int32_t>(), 3 * 3 * 4);
    for (const std::vector<float>* values : {&std::as_const(b), &g, &r})
      for (int x = 0; x < 3; ++x) EXPECT_EQ(file.get<float>(), (*values)[std::size_t(3 * y + x)]);
  }
  EXPECT_EQ(file.at, file.size());
}

}  // namespace exr_test
}  // namespace tureen
