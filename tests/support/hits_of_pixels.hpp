// The oracle's hits, pixel by pixel.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "oracle/hits.hpp"

namespace tureen::test {

/// visit(column, row, hits) for every pixel of the camera with a hit, row by row from the top. The
/// hits are sorted by depth, ties by face.
inline void visit_pixels(
    const oracle::Rays& rays, const Camera& camera,
    const std::function<void(int column, int row, std::span<const oracle::Hit> hits)>& visit) {
  std::map<std::pair<int, int>, std::vector<oracle::Hit>> pixels;  // by row and column
  rays.visit_faces(0, camera.height, [&](int column, int row, const oracle::Hit& hit) {
    pixels[{row, column}].push_back(hit);
  });
  for (auto& [place, hits] : pixels) {
    std::sort(hits.begin(), hits.end(), [](const oracle::Hit& a, const oracle::Hit& b) {
      return std::tie(a.depth, a.face) < std::tie(b.depth, b.face);
    });
    visit(place.second, place.first, hits);
  }
}

}  // namespace tureen::test
