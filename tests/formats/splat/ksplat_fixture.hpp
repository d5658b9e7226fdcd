// .ksplat files of two splats, byte by byte.
#pragma once

#include <cstring>
#include <glm/gtc/packing.hpp>
#include <string>

#include "tests/formats/torch_fixture.hpp"

namespace tureen::test {

/// One section of degree 1 with a full bucket of one splat, at (1, 2, 3), and a partly filled one
/// with another, at (-1, 0, 0.5); scales 0.5, 0.25, 0.125; the quaternion (w, x, y, z) =
/// (0.5, 0.5, -0.5, 0.5); bytes of colour 255, 0, 51 and 102; harmonic k of channel c is
/// (k + 3 c) / 8 - 1.
inline std::string two_ksplats(int level) {
  const auto put = [](std::string& text, std::size_t at, std::uint64_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) text[at + i] = char(value >> (8 * i));
  };
  const auto append_float = [](std::string& text, float value) {
    text.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const auto append_part = [&](std::string& text, float value) {
    if (level == 0)
      append_float(text, value);
    else
      append_little(text, glm::packHalf1x16(value), 2);
  };
  std::string head(4096, '\0'), section(1024, '\0');
  head[1] = 1;
  for (const std::size_t at : {4, 8}) put(head, at, 1, 4);
  for (const std::size_t at : {12, 16}) put(head, at, 2, 4);
  put(head, 20, std::uint64_t(level), 2);
  for (const std::size_t at : {0, 4}) put(section, at, 2, 4);
  put(section, 8, 1, 4);
  put(section, 12, level > 0 ? 2 : 0, 4);
  const float side = 4;
  std::memcpy(&section[16], &side, 4);
  put(section, 20, 12, 2);
  put(section, 24, 32767, 4);
  put(section, 32, level > 0 ? 1 : 0, 4);
  put(section, 36, level > 0 ? 1 : 0, 4);
  put(section, 40, 1, 2);
  std::string content;
  const float centers[2][3] = {{1, 2, 3}, {-1, 0, 0.5f}}, middles[2][3] = {{1, 1, 3}, {0, 0, 0.5f}};
  if (level > 0) {
    append_little(content, 1, 4);
    for (const auto& middle : middles)
      for (const float value : middle) append_float(content, value);
  }
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < 3; ++k)
      if (level == 0)
        append_float(content, centers[i][k]);
      else
        append_little(content,
                      std::uint64_t(32767 + (centers[i][k] - middles[i][k]) / 2 * 32767 + 0.5f), 2);
    for (const float scale : {0.5f, 0.25f, 0.125f}) append_part(content, scale);
    for (const float part : {0.5f, 0.5f, -0.5f, 0.5f}) append_part(content, part);
    content += std::string("\xff\x00\x33\x66", 4);
    for (int c = 0; c < 3; ++c)
      for (int k = 1; k <= 3; ++k) {
        const float value = float(k + 3 * c) / 8 - 1;
        if (level < 2)
          append_part(content, value);
        else
          append_little(content, std::uint64_t((value + 1.5f) / 3 * 255 + 0.5f), 1);
      }
  }
  return head + section + content;
}

}  // namespace tureen::test
