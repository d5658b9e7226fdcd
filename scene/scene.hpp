// A trained scene: one kind of primitive with metadata.
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
  bool up_is_assumed = false;      // by the reader: the file does not store it
  glm::vec3 background{0.0f};      // display-referred
  std::string source;              // the method or format of origin, free text
  bool compressed = false;         // read from a compressed file
  std::vector<Remark> remarks;     // assumptions and losses of the reader
  std::vector<std::string> notes;  // stored in the file: free text, never interpreted
};

/// The notes, followed by the descriptions of the remarks.
std::vector<std::string> all_notes(const SceneInfo& info);

struct Scene {
  std::variant<TriangleSoup, SoftTriangles> primitives;
  std::vector<Camera> cameras;
  glm::dvec3 origin{0.0};  // world = origin + position
  SceneInfo info;
  Quality quality = {};  // without a defect()
};

/// The soup to render: the scene's own, or its soft triangles converted by to_opaque. The losses of
/// the conversion are added to info.remarks. Afterwards the scene holds a TriangleSoup.
TriangleSoup& opaque_soup(Scene& scene);

}  // namespace tureen
