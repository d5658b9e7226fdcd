// What a frame can show of a soup beside its final colour, so that people see what they have:
// names, which soups have it, and the numbers behind the colours. docs/looking.md shows each.
// runtime/debug_views/inspector.hpp draws them.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "image/heat_map.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen {

enum class Inspection {
  color,        // as it is drawn
  depth,        // along the viewing axis: near is bright
  normals,      // (n + 1) / 2, world axes, turned towards the eye
  triangle_id,  // a colour a face
  texels,       // the nearest texel of lattice or image instead of an interpolated one
  alpha,        // also where the alpha test throws a fragment away
  mlp_weight,   // how much of the color MLP is blended in
  features,     // what is stored, before any network
  overdraw,     // fragments a pixel
  wireframe,    // edges over the dimmed final colour
};

struct InspectionName {
  Inspection what;
  const char* name;     // "triangle-id", for the command line
  const char* title;    // "triangle id", for people
  const char* meaning;  // in a few words
};

/// All of them, in the order of the enumeration.
std::span<const InspectionName> inspection_names();

const char* name_of(Inspection what);

/// By name; nothing when there is none of that name.
std::optional<Inspection> inspection_named(std::string_view name);

/// Which features are shown: one as grey, two or three as red, green and blue.
struct FeatureChoice {
  int first = 0;  // from 0
  int count = 3;  // 1..3
};

/// How many features a pixel of this soup has: 7 of a lattice, 8 of textures with a color MLP, else
/// none.
int feature_count(const TriangleSoup& soup);

/// Why this soup has nothing to show there, in a sentence for people; or nothing.
std::optional<std::string> why_not(Inspection what, const TriangleSoup& soup);
/// The same for a choice of so many features, which are more than none.
std::optional<std::string> why_not(const FeatureChoice& choice, int feature_count);

// -- the numbers behind the colours, which the shaders have too ---------------------------------

/// A bright colour a face, of 2^24, always the same: its index with all bits mixed.
glm::vec3 triangle_color(std::uint32_t face);

/// The colours of depth: heat_ramp(1 - t), t = ln(z / near) / ln(far / near), where z is the
/// distance along the viewing axis. Logarithmic, so that equal ratios of depth are equal steps.
struct DepthScale {
  double near = 1, far = 2;             // 0 < near < far
  double position(double depth) const;  // t, in [0, 1]
};

/// near = max(d - r, (d + r) / 50), far = d + r for bounds of the radius r whose centre is d away
/// from the eye: it does not change as the eye turns, and needs no look at the picture.
DepthScale depth_scale(const Bounds& bounds, glm::dvec3 eye);

/// The box that holds the middle 98 % of the faces' corners along each axis: a few stray faces far
/// away do not take all colours. bounds() of soups that are too small for it.
Bounds middle_bounds(const TriangleSoup& soup);

/// The most fragments that are told apart.
inline constexpr int most_counted_fragments = 255;

/// The colour of so many fragments: heat_ramp(log2(count) / 8). 0 is the background.
glm::vec3 overdraw_color(int count);

/// The colour of a fragment that the alpha test throws away, from 0 (alpha is 0) to 1 (it just
/// fails): violets, so that they are told from the greys of what is kept.
glm::vec3 cut_out_color(float part_of_threshold);

/// What the colours mean, for a legend beside the picture; empty where they speak for themselves.
Legend legend(Inspection what, const DepthScale& scale, const FeatureChoice& choice);

}  // namespace tureen
