// Debug views: quantities of soups and splats that a frame can show besides its final colour.
// Defines their names, their availability for a layer, and the values behind the colours.
// docs/debug-views.md shows each. runtime/debug_views/debug_views.hpp draws them.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "image/heat_map.hpp"
#include "scene/scene.hpp"

namespace tureen {

enum class DebugView {
  color,          // as rendered
  depth,          // along the viewing axis; near is bright
  normals,        // (n + 1) / 2, world axes, turned towards the eye
  triangle_id,    // one colour a face
  texels,         // the nearest texel of lattice or image, without interpolation
  alpha,          // also for fragments that the alpha test rejects
  mlp_weight,     // blend weight of the color MLP
  features,       // the stored values, before any network
  overdraw,       // fragments a pixel
  wireframe,      // edges over the dimmed final colour
  holes,          // pixels without a triangle among covered ones, over the dimmed final colour
  median_depth,   // of splats: at a transmittance of 1/2; of soups as depth
  opacity,        // of splats, their weighted mean
  sigma,          // of triangle windows, their weighted mean
  contributions,  // splats a pixel, until it is closed
  order,          // of the first splat in the order of blending
  quarter,        // the final colour of a quarter of the splats
};

struct DebugViewName {
  DebugView what;
  const char* name;     // "triangle-id", for the command line
  const char* title;    // "triangle id", for display
  const char* meaning;  // in a few words
  const char* meaning_for_splats = meaning;
};

/// What a debug view shows, for its words: a scene with triangles, or splats alone.
enum class Subjects { triangles, splats };
inline const char* meaning_of(const DebugViewName& name, Subjects subjects) {
  return subjects == Subjects::splats ? name.meaning_for_splats : name.meaning;
}

/// All debug views, in the order of the enumeration.
std::span<const DebugViewName> debug_view_names();

const char* name_of(DebugView what);

/// The debug view with this name, or nullopt.
std::optional<DebugView> debug_view_named(std::string_view name);

/// The displayed features: one as grey, two or three as red, green and blue.
struct FeatureChoice {
  int first = 0;  // from 0
  int count = 3;  // 1..3
  bool operator==(const FeatureChoice& other) const = default;
};

/// Number of features of a pixel of this soup: 7 for a lattice, 8 for textures with a color MLP,
/// otherwise 0.
int feature_count(const TriangleSoup& soup);

/// The reason why this debug view is not available for this layer, as a sentence, or nullopt.
std::optional<std::string> why_not(DebugView what, const TriangleSoup& soup);
std::optional<std::string> why_not(DebugView what, const Splats& splats);
std::optional<std::string> why_not(DebugView what, const Primitives& primitives);
/// The same for a choice among `feature_count` features, which is above 0.
std::optional<std::string> why_not(const FeatureChoice& choice, int feature_count);

// -- the values behind the colours, which the shaders also compute ------------------------------

/// A bright colour for each face, one of 2^24, deterministic: a hash of its index and its layer's.
glm::vec3 triangle_color(std::uint32_t face, std::uint32_t layer = 0);

/// The colours of depth: heat_ramp(1 - t), t = ln(z / near) / ln(far / near), where z is the
/// distance along the viewing axis. The scale is logarithmic, so equal ratios of depth are equal
/// steps.
struct DepthScale {
  double near = 1, far = 2;             // 0 < near < far
  double position(double depth) const;  // t, in [0, 1]
};

/// near = max(d - r, (d + r) / 50), far = d + r for bounds of radius r with their centre at
/// distance d from the eye. It is independent of the viewing direction and of the image.
DepthScale depth_scale(const Bounds& bounds, glm::dvec3 eye);

/// Largest fragment count with its own colour.
inline constexpr int max_counted_fragments = 255;

/// Part of the splats that DebugView::quarter shows; a hash of the index chooses them.
inline constexpr float shown_fraction = 0.25f;

/// The colour of a fragment count: heat_ramp(log2(count) / 8). A count of 0 has the background's
/// colour.
glm::vec3 overdraw_color(int count);

/// The colour of a pixel that shows no triangle, although most of the 5x5 pixels around it do.
inline constexpr glm::vec3 hole_color{1.0f, 0.0f, 1.0f};

/// The colour of a fragment that the alpha test rejects: violets, distinct from the greys of kept
/// fragments. `part_of_threshold` is alpha / threshold, 0..1.
glm::vec3 cut_out_color(float part_of_threshold);

/// Legend of the colours, shown beside the image; empty for self-explanatory colours.
Legend legend(DebugView what, const DepthScale& scale, const FeatureChoice& choice,
              Subjects subjects = Subjects::triangles);

}  // namespace tureen
