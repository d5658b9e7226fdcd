// Scenes for tests of rays.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <utility>
#include <vector>

#include "scene/scene.hpp"
#include "tests/support/random.hpp"

namespace tureen::test {

inline void in_order(std::size_t count, const std::function<void(std::size_t)>& body) {
  for (std::size_t i = 0; i < count; ++i) body(i);
}

inline Layer layer_of(Primitives primitives, const glm::dmat4& place = glm::dmat4(1.0)) {
  return {.world_from_layer = place, .primitives = std::move(primitives)};
}

/// A sphere of radius 1 with normals, all of one colour.
inline TriangleSoup unit_ball(int subdivisions, const glm::vec3& color = glm::vec3(0.5f)) {
  TriangleSoup soup;
  soup.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  soup.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                    {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    std::vector<glm::uvec3> finer;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] = middles.try_emplace(std::minmax(a, b), soup.positions.size());
      if (is_new) soup.positions.push_back(glm::normalize(soup.positions[a] + soup.positions[b]));
      return at->second;
    };
    for (const glm::uvec3& t : soup.triangles) {
      const std::uint32_t a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      for (const glm::uvec3& each :
           {glm::uvec3(t[0], a, c), glm::uvec3(a, t[1], b), glm::uvec3(c, b, t[2]), {a, b, c}})
        finer.push_back(each);
    }
    soup.triangles = std::move(finer);
  }
  soup.normals = soup.positions;
  soup.appearance =
      FaceColors{std::vector<glm::vec4>(soup.triangles.size(), glm::vec4(color, 1.0f))};
  return soup;
}

/// Two triangles between four corners, with a colour at each.
inline TriangleSoup quad(const std::vector<glm::vec3>& corners,
                         const std::vector<glm::vec4>& colors) {
  TriangleSoup soup;
  soup.positions = corners;
  soup.triangles = {{0, 1, 2}, {0, 2, 3}};
  soup.appearance = VertexColors{colors};
  return soup;
}
inline TriangleSoup quad(const std::vector<glm::vec3>& corners, const glm::vec3& color) {
  return quad(corners, std::vector<glm::vec4>(4, glm::vec4(color, 1.0f)));
}

inline Layer with(Layer layer, const Material& material) {
  layer.material = material;
  return layer;
}

inline glm::dmat4 ball_at(const glm::dvec3& center, double radius) {
  return glm::scale(glm::translate(glm::dmat4(1.0), center), glm::dvec3(radius));
}

}  // namespace tureen::test
