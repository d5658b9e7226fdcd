// A gizmo: arrows, rings or a circle over a layer, which the pointer drags to move, turn or scale
// it. Mathematics alone; viewer/panels/gizmo_overlay.cpp draws it and follows the pointer. Image
// coordinates are those of the camera: from the upper left corner, to the right and down.
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scene/camera.hpp"
#include "scene/document/document.hpp"
#include "scene/layer_place.hpp"

namespace tureen::viewer {

enum class GizmoTool { off, move, turn, scale };
enum class GizmoAxes { world, layer };

/// A part that can be dragged.
struct GizmoHandle {
  enum class Kind {
    axis,   // moves along it
    plane,  // moves in the plane across it
    ring,   // turns about it
    size,   // scales
  };
  Kind kind = Kind::axis;
  int axis = 0;                   // 0..2: x, y, z
  std::vector<glm::dvec2> shape;  // a line, in image coordinates; of a plane its four corners
};

struct Gizmo {
  Camera camera;
  glm::dvec3 center{0.0};  // in world coordinates
  glm::dmat3 axes{1.0};    // columns of unit length
  double arm = 1;          // length of an arrow, and radius of a ring, in world units

  /// The point in the image; nullopt if it is not in front of the camera.
  std::optional<glm::dvec2> project(const glm::dvec3& point) const;
  /// Parts that are seen from their end, and could not be dragged, are left out.
  std::vector<GizmoHandle> handles(GizmoTool tool) const;
};

/// The gizmo in the middle of a layer's box. `arm`: in units of the image at that depth. nullopt if
/// the middle is not in front of the camera.
std::optional<Gizmo> gizmo_of(const LayerPlace& layer, GizmoAxes axes, const Camera& camera,
                              double arm);

/// The index of the handle within `reach` of this point, the nearest one; nullopt if there is none.
std::optional<std::size_t> handle_at(const std::vector<GizmoHandle>& handles,
                                     const glm::dvec2& point, double reach);

/// A drag of a handle, from its beginning on.
struct GizmoDrag {
  Gizmo gizmo;
  GizmoHandle handle;
  glm::dvec2 from{0.0};
  glm::dmat4 world_from_layer{1.0};
  LayerId layer = {};
};
enum class Snapping { off, on };
struct GizmoChange {
  glm::dmat4 world_from_layer{1.0};  // a similarity
  std::string text;                  // "x 0.25", "15°", "× 1.5"
};
/// The layer's place when the pointer is at `to`. With snapping, it moves by multiples of 1, 2 or 5
/// times a power of ten, about a fifth of an arm; turns by multiples of 15 degrees; and scales by
/// multiples of 0.1. nullopt where the pointer's ray does not determine it.
std::optional<GizmoChange> change_of(const GizmoDrag& drag, const glm::dvec2& to,
                                     Snapping snapping);

}  // namespace tureen::viewer
