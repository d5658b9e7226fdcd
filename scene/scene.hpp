// A scene: layers of primitives, cameras and metadata.
#pragma once

#include <cstddef>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/camera.hpp"
#include "scene/material.hpp"
#include "scene/quality.hpp"
#include "scene/remark.hpp"
#include "scene/splats.hpp"
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

/// Sets the up axis by the user's choice, and removes the remarks that the file stores none.
void choose_up(SceneInfo& info, const glm::vec3& up);

/// The notes, followed by the descriptions of the remarks.
std::vector<std::string> all_notes(const SceneInfo& info);

using Primitives = std::variant<TriangleSoup, Splats>;

/// One set of primitives of a scene.
struct Layer {
  std::string name = {};
  /// World from layer coordinates: a similarity (rotation, translation, one scale, optionally a
  /// mirror).
  glm::dmat4 world_from_layer{1.0};
  bool visible = true;
  Primitives primitives = {};
  /// Only of soups: a mirror or glass for rays. Default: drawn by its appearance.
  std::optional<Material> material = {};
};

/// The translation by `origin`, in world coordinates: the world_from_layer of a layer whose
/// vertices are relative to `origin`.
glm::dmat4 at_origin(const glm::dvec3& origin);

/// The translation of world_from_layer: the layer's origin in world coordinates. It places the
/// vertices (world = origin + position) only if world_from_layer has no rotation, scale or mirror.
glm::dvec3 origin_of(const Layer& layer);

/// The box around the layer's primitives, in layer coordinates; zeros if there are none.
Bounds bounds(const Layer& layer);

/// The reason why world_from_layer is not a similarity (a number that is not finite, a perspective
/// row, a scale of zero, a stretch or shear beyond rounding), or why the material has a defect(),
/// or nullopt. A mirrored layer is no defect. The primitives are not checked.
std::optional<std::string> defect(const Layer& layer);

/// The layer's name. If it is empty: "layer 2" for the second layer, `index` 1.
std::string label(const Layer& layer, std::size_t index);

/// Largest number of layers of a scene. The runtime marks the pixels of each layer in the stencil
/// buffer, which has 8 bits; 0 is the background.
inline constexpr std::size_t max_layers = 255;

struct Scene {
  std::vector<Layer> layers;  // at equal depth the earlier layer wins
  std::vector<Camera> cameras;
  SceneInfo info;
  Quality quality = {};  // without a defect()
  /// The view that programs show first; by default one of the cameras (camera/capture.hpp).
  std::optional<Camera> first_view = {};
};

/// A scene of one visible layer without a name, at `origin` in world coordinates.
Scene scene_of(Primitives primitives, const glm::dvec3& origin = glm::dvec3(0.0));

/// The layer of a scene with one layer. Throws UsageError, which names the layers, if the scene has
/// any other number of layers.
Layer& only_layer(Scene& scene);
const Layer& only_layer(const Scene& scene);

/// The soup of a scene with one layer. Throws UsageError like only_layer. Splats in this layer are
/// a programming error: call make_opaque before.
TriangleSoup& only_soup(Scene& scene);
const TriangleSoup& only_soup(const Scene& scene);

/// The layer with this label(); if there is none, "layer 2" is the second one, and the scene's name
/// that of an only layer. Throws UsageError, which lists the labels, for no layer or several.
Layer& layer_named(Scene& scene, const std::string& name);

/// Removes all layers but layer_named(), which keeps its transform and becomes visible.
void keep_layer(Scene& scene, const std::string& name);

/// Gives all splats of the scene this profile (named_profiles), by the user's choice, and removes
/// the remarks that the file stores none. Throws UsageError, which names the layer, if a kernel
/// does not support the profile, and if the scene has no splats.
void choose_profile(Scene& scene, std::string_view name);

/// Whether a layer is visible.
bool has_visible_layer(const Scene& scene);

/// Bytes in the vectors of all layers.
std::size_t byte_size(const Scene& scene);

/// Whether merged() turns scenes whose up axis differs from the first scene's.
enum class UpAxes { turn, keep };

/// One scene with all layers, in order. Needs at least one scene; a single scene stays as it is.
/// Cameras, first view, quality and info are those of the first scene, except:
/// - A further scene with another up axis is turned upright, with a remark
/// (scene/edit/moved_scene.hpp).
/// - Layers without a name get the name of their scene. Equal names get numbers: "fox", "fox 2".
/// - Remarks and notes are those of all scenes, with the scene's name. Notes of a scene with
/// several
///   layers stay as they are, and equal notes appear once. A remark lists the settings
///   of a further scene that differ from the first scene's and are dropped.
/// - `compressed` is true if one scene is.
/// Throws UsageError for more than max_layers layers.
Scene merged(std::vector<Scene> scenes, UpAxes differing = UpAxes::turn);

/// Sums over all layers, hidden ones too.
std::size_t triangle_count(const Scene& scene);
std::size_t splat_count(const Scene& scene);
/// "1,200 triangles", "20,000 splats", or both.
std::string primitives_text(std::uint64_t triangles, std::uint64_t splats);

/// Converts the triangle windows of every layer by to_opaque. The losses of the conversions are
/// added to info.remarks. Afterwards every layer holds a TriangleSoup. Throws UsageError, which
/// names the layer, for splats with another kernel.
void make_opaque(Scene& scene);

}  // namespace tureen
