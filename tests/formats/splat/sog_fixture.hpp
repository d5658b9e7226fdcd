// SOG scenes of two splats in folders and archives, image by image.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "image/codecs/webp.hpp"
#include "tests/formats/torch_fixture.hpp"

namespace tureen::test {

using SogFiles = std::vector<std::pair<std::string, std::string>>;

inline std::string webp_text(const Image8& image) {
  const std::vector<std::byte> bytes = encode_webp(image, 6);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// An image of 2 x 1 pixels.
inline std::string two_pixels(glm::u8vec4 first, glm::u8vec4 second) {
  Image8 image(2, 1);
  image.pixels = {first, second};
  return webp_text(image);
}

/// Centres (e - 1, 0, 0) and (0, 0, 1 - e); version 2 has the logarithms of scales k / 64 - 4 for
/// byte k, colours k / 128 - 1, and a palette of degree 1 with two entries.
inline SogFiles two_splats(int version, bool has_palette = true) {
  nlohmann::json meta = {{"means",
                          {{"shape", {2, 3}},
                           {"mins", {0, -1, -1}},
                           {"maxs", {1, 1, 1}},
                           {"files", {"means_l.webp", "means_u.webp"}}}},
                         {"quats", {{"files", {"quats.webp"}}}}};
  std::vector<double> scales, colors, rest;
  for (int k = 0; k < 256; ++k) {
    scales.push_back(k / 64.0 - 4);
    colors.push_back(k / 128.0 - 1);
    rest.push_back(k / 256.0);
  }
  if (version == 2) {
    meta.update({{"version", 2}, {"count", 2}});
    meta["scales"] = {{"codebook", scales}, {"files", {"scales.webp"}}};
    meta["sh0"] = {{"codebook", colors}, {"files", {"sh0.webp"}}};
  } else {
    meta["scales"] = {{"mins", {-4, -4, -4}},
                      {"maxs", {255 / 64.0 - 4, 255 / 64.0 - 4, 255 / 64.0 - 4}},
                      {"files", {"scales.webp"}}};
    meta["sh0"] = {{"mins", {-1, -1, -1, -2}},
                   {"maxs", {127 / 128.0, 127 / 128.0, 127 / 128.0, 2}},
                   {"files", {"sh0.webp"}}};
  }
  SogFiles files{{"means_l.webp", two_pixels({255, 255, 255, 255}, {0, 255, 0, 255})},
                 {"means_u.webp", two_pixels({255, 127, 127, 255}, {0, 127, 0, 255})},
                 {"quats.webp", two_pixels({128, 128, 128, 252}, {0, 128, 128, 254})},
                 {"scales.webp", two_pixels({0, 64, 128, 255}, {255, 192, 128, 255})},
                 {"sh0.webp", two_pixels({0, 128, 192, 255}, {1, 2, 3, 0})}};
  if (has_palette) {
    nlohmann::json palette = {{"files", {"shN_centroids.webp", "shN_labels.webp"}}};
    if (version == 2)
      palette.update({{"count", 2}, {"bands", 1}, {"codebook", rest}});
    else
      palette.update({{"mins", 0}, {"maxs", 255 / 256.0}});
    meta["shN"] = palette;
    Image8 entries(64 * 3, 1);
    for (int x = 0; x < 6; ++x) entries.at(x, 0) = glm::u8vec4(10 * x, 10 * x + 1, 10 * x + 2, 255);
    files.emplace_back("shN_centroids.webp", webp_text(entries));
    files.emplace_back("shN_labels.webp", two_pixels({1, 0, 0, 255}, {0, 0, 0, 255}));
  }
  files.emplace(files.begin(), "meta.json", meta.dump());
  return files;
}

/// Two levels, of four and two splats, and an environment of two; `version`: of their files.
inline SogFiles streamed_splats(int version = 2) {
  SogFiles files;
  for (const char* folder : {"0_0", "0_1", "1_0", "env"})
    for (const auto& [name, content] : two_splats(version, false))
      files.emplace_back(std::string(folder) + "/" + name, content);
  const auto range = [](int file) {
    return nlohmann::json{{"file", file}, {"offset", 0}, {"count", 2}};
  };
  const nlohmann::json bound = {{"min", {0, 0, 0}}, {"max", {1, 1, 1}}};
  const nlohmann::json meta = {{"lodLevels", 2},
                               {"environment", "env/meta.json"},
                               {"filenames", {"0_0/meta.json", "0_1/meta.json", "1_0/meta.json"}},
                               {"tree",
                                {{"bound", bound},
                                 {"children",
                                  {{{"bound", bound}, {"lods", {{"0", range(0)}, {"1", range(2)}}}},
                                   {{"bound", bound}, {"lods", {{"0", range(1)}}}}}}}}};
  files.emplace(files.begin(), "lod-meta.json", meta.dump());
  return files;
}

inline std::string zipped(const SogFiles& files) {
  ZipFixture zip;
  for (const auto& [name, content] : files) zip.entries.push_back({name, content});
  return zip.bytes();
}

}  // namespace tureen::test
