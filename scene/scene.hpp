// A trained scene: one kind of primitive, and what is known about it.
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <variant>
#include <vector>

#include "scene/camera.hpp"
#include "scene/quality.hpp"
#include "scene/remark.hpp"
#include "scene/soft_triangles.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

struct SceneInfo {
  std::string name;
  glm::vec3 up{0.0f, 1.0f, 0.0f};  // unit length
  bool up_is_assumed = false;      // by the reader: the file does not say it
  glm::vec3 background{0.0f};      // display-referred
  std::string source;              // the method or format it came from, for people
  bool compressed = false;         // read from a slim file
  std::vector<Remark> remarks;     // what reading it assumed or lost
  std::vector<std::string> notes;  // stored in the file: text for people, which nothing interprets
};

/// The notes, and after them the remarks described.
std::vector<std::string> all_notes(const SceneInfo& info);

struct Scene {
  std::variant<TriangleSoup, SoftTriangles> primitives;
  std::vector<Camera> cameras;
  glm::dvec3 origin{0.0};  // world = origin + position
  SceneInfo info;
  Quality quality = {};  // without a defect()
};

/// The soup to draw: the scene's own, or what becomes of its soft triangles (to_opaque), with
/// what that loses added to info.remarks. The scene holds a TriangleSoup afterwards.
TriangleSoup& opaque_soup(Scene& scene);

}  // namespace tureen
