#include "scene/lint/lint.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "scene/finite.hpp"
#include "scene/lattice.hpp"
#include "scene/lint/lint_findings.hpp"

namespace tureen {

namespace {

bool is_degenerate(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a, bc = c - b;
  const double longest_squared = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
  // Float coordinates cannot represent triangles thinner than about 1e-7 of their length, except
  // near the origin. 1e-12 is far below any intended area. `<=` also accepts coincident corners.
  return glm::length(glm::cross(ab, ac)) <= 1e-12 * longest_squared;
}

// --- Duplicates -----------------------------------------------------------------------------

using Bits = std::array<std::uint32_t, 3>;

/// The corners' coordinates as bits, in an order that does not depend on the face's corner order.
std::array<Bits, 3> canonical_corners(const TriangleSoup& soup, std::uint32_t face) {
  std::array<Bits, 3> corners;
  for (int k = 0; k < 3; ++k) {
    const glm::vec3 p = soup.positions[soup.triangles[face][k]] + 0.0f;  // -0 becomes 0
    for (int c = 0; c < 3; ++c) std::memcpy(&corners[k][c], &p[c], sizeof(float));
  }
  std::sort(corners.begin(), corners.end());
  return corners;
}

std::uint64_t hash(const std::array<Bits, 3>& corners) {
  // FNV-1a over words, with the product's high bits folded down. Faces with equal hashes are
  // compared.
  std::uint64_t h = 14695981039346656037ull;
  for (const Bits& corner : corners)
    for (const std::uint32_t word : corner) {
      h = (h ^ word) * 1099511628211ull;
      h ^= h >> 29;
    }
  return h;
}

void find_duplicates(const TriangleSoup& soup, const std::vector<bool>& ordinary,
                     LintFinding& finding) {
  struct Entry {
    std::uint64_t hash;
    std::uint32_t face;
  };
  std::vector<Entry> entries;
  entries.reserve(soup.triangles.size());
  for (std::uint32_t face = 0; face < soup.triangles.size(); ++face)
    if (ordinary[face]) entries.push_back({hash(canonical_corners(soup, face)), face});
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.hash != b.hash ? a.hash < b.hash : a.face < b.face;
  });
  std::vector<std::uint32_t> duplicates;
  for (std::size_t begin = 0, end; begin < entries.size(); begin = end) {
    end = begin + 1;
    while (end < entries.size() && entries[end].hash == entries[begin].hash) ++end;
    if (end - begin == 1) continue;
    // Faces with equal hashes nearly always have equal corners. Sorted by corners and then by face,
    // the first face of each group is not a duplicate.
    std::vector<std::pair<std::array<Bits, 3>, std::uint32_t>> run;
    for (std::size_t i = begin; i < end; ++i)
      run.emplace_back(canonical_corners(soup, entries[i].face), entries[i].face);
    std::sort(run.begin(), run.end());
    for (std::size_t i = 1; i < run.size(); ++i)
      if (run[i].first == run[i - 1].first) duplicates.push_back(run[i].second);
  }
  std::sort(duplicates.begin(), duplicates.end());
  for (const std::uint32_t face : duplicates) count(finding, face);
}

// --- Visibility -----------------------------------------------------------------------------

/// Whether alpha is below the threshold everywhere on a face. Interpolation is convex, so checking
/// the corners or the texels is sufficient.
struct NeverVisible {
  const TriangleSoup& soup;
  std::vector<bool> cut_out_materials;  // UV textures: no texel reaches the threshold

  explicit NeverVisible(const TriangleSoup& s) : soup(s) {
    if (const auto* textures = std::get_if<UvTextures>(&soup.appearance))
      for (const UvMaterial& material : textures->materials)
        cut_out_materials.push_back(is_cut_out(*textures, material));
  }

  static bool is_cut_out(const UvTextures& textures, const UvMaterial& material) {
    if (!(material.mask_threshold > 0.0f)) return false;
    const int channel = material.mask_channel;
    float largest = 1.0f;
    if (!material.images.empty()) {
      int byte = 0;
      for (const glm::u8vec4& texel : textures.images[material.images[0]].pixels)
        byte = std::max(byte, int(texel[channel]));
      largest = float(byte) / 255.0f;
    }
    if (!textures.mlp) largest *= material.factor[channel];
    // A vertex colour above 1 may raise the mask above the threshold.
    if (!textures.mlp && !textures.vertex_rgba.empty()) {
      float factor = 0.0f;
      for (const glm::vec4& color : textures.vertex_rgba) factor = std::max(factor, color[channel]);
      largest *= factor;
    }
    return largest < material.mask_threshold;
  }

  bool operator()(std::size_t face) const {
    return std::visit([&](const auto& appearance) { return hidden(appearance, face); },
                      soup.appearance);
  }

  bool hidden(const FaceColors& colors, std::size_t face) const {
    return colors.rgba[face].a < alpha_threshold;
  }
  bool hidden(const VertexColors& colors, std::size_t face) const {
    const glm::uvec3& t = soup.triangles[face];
    return colors.rgba[t.x].a < alpha_threshold && colors.rgba[t.y].a < alpha_threshold &&
           colors.rgba[t.z].a < alpha_threshold;
  }
  bool hidden(const Harmonics&, std::size_t) const { return false; }
  bool hidden(const LatticeTexture& texture, std::size_t face) const {
    const LatticePatch& patch = texture.patches[face];
    const std::size_t texels = lattice::texel_count(int(patch.level));
    for (std::size_t i = 0; i < texels; ++i)
      if (!(texture.value(patch.first_texel + i, LatticeTexture::features) < alpha_threshold))
        return false;
    return true;
  }
  bool hidden(const UvTextures& textures, std::size_t face) const {
    return cut_out_materials[textures.material_of_face[face]];
  }
};

/// The words of a finding, by its id: one element, several, and the predicate for each.
struct Wording {
  const char *name, *one, *many, *of_one, *of_many;
};

constexpr Wording wordings[] = {
    {"non_finite_vertices", "vertex", "vertices", "is not finite (NaN or infinity)",
     "are not finite (NaN or infinity)"},
    {"degenerate_faces", "face", "faces", "is degenerate (zero area)",
     "are degenerate (zero area)"},
    {"duplicate_faces", "face", "faces", "repeats the corners of an earlier face",
     "repeat the corners of an earlier face"},
    {"never_visible_faces", "face", "faces", "is transparent everywhere",
     "are transparent everywhere"},
    {"unused_vertices", "vertex", "vertices", "is used by no face", "are used by no face"},
    {"far_from_origin", "", "", "", ""},  // describe() has a sentence for it
    {"transparent_splats", "splat", "splats", "is too transparent to be drawn",
     "are too transparent to be drawn"},
    {"collapsed_splats", "splat", "splats", "has a size of 0 along an axis",
     "have a size of 0 along an axis"},
    {"needle_splats", "splat", "splats", "is over 2000 times as long as wide",
     "are over 2000 times as long as wide"},
    {"outlying_splats", "splat", "splats", "is far from the others, or larger than their extent",
     "are far from the others, or larger than their extent"},
    {"duplicate_splats", "splat", "splats", "repeats an earlier splat", "repeat an earlier splat"},
    {"large_near_limit", "", "", "", ""},  // describe() has a sentence for it
    {"zero_harmonics", "coefficient", "harmonics coefficients", "is 0 for all splats",
     "are 0 for all splats"},
};

}  // namespace

const char* name_of(LintFinding::Id id) { return wordings[std::size_t(id)].name; }

std::string describe(const LintFinding& finding) {
  if (finding.id == LintFinding::Id::far_from_origin)
    return "the vertices lie too far from the origin for 32-bit floats: the extent is only " +
           std::to_string(finding.extent_over_offset) +
           " of the largest coordinate (below 0.0002); store them relative to an origin";
  if (finding.id == LintFinding::Id::large_near_limit)
    return "the near limit, the depth up to which no splat is drawn, is above half the radius in "
           "which the splats lie: usual views lose splats";
  const bool single = finding.count == 1;
  const Wording& words = wordings[std::size_t(finding.id)];
  std::string text = std::to_string(finding.count) + " of " + std::to_string(finding.of) + " " +
                     words.many + " " + (single ? words.of_one : words.of_many) + ": " +
                     (single ? words.one : words.many);
  for (std::size_t i = 0; i < finding.first.size(); ++i)
    text += (i ? ", " : " ") + std::to_string(finding.first[i]);
  return text + (finding.count > finding.first.size() ? " ..." : "");
}

void count(LintFinding& finding, std::size_t index) {
  ++finding.count;
  std::vector<std::uint32_t>& first = finding.first;
  if (first.size() == LintFinding::shown) {
    if (index >= first.back()) return;
    first.pop_back();
  }
  first.insert(std::upper_bound(first.begin(), first.end(), index), std::uint32_t(index));
}

void add_counted(Lint& lint, std::initializer_list<LintFinding*> findings) {
  for (LintFinding* finding : findings)
    if (finding->count > 0) lint.findings.push_back(std::move(*finding));
}

void add_distance_from_origin(Lint& lint, const Bounds& box) {
  double offset = 0;
  for (int c = 0; c < 3; ++c)
    offset = std::max({offset, std::abs(double(box.low[c])), std::abs(double(box.high[c]))});
  // At 2e-4 the spacing of floats at that offset is 1 / 3000 of the extent: about a pixel if the
  // box fills a screen (docs/numerics.md, G3b).
  constexpr double smallest_ratio = 2e-4;
  lint.extent_over_offset = offset > 0 ? 2 * box.radius() / offset : 0;
  if (offset > 0 && lint.extent_over_offset < smallest_ratio)
    lint.findings.push_back(
        {.id = LintFinding::Id::far_from_origin, .extent_over_offset = lint.extent_over_offset});
}

const LintFinding* Lint::find(LintFinding::Id id) const {
  const auto found = std::find_if(findings.begin(), findings.end(),
                                  [&](const LintFinding& finding) { return finding.id == id; });
  return found == findings.end() ? nullptr : &*found;
}

Lint lint(const TriangleSoup& soup) {
  LintFinding non_finite{.id = LintFinding::Id::non_finite_vertices, .of = soup.positions.size()};
  LintFinding degenerate{.id = LintFinding::Id::degenerate_faces, .of = soup.triangles.size()};
  LintFinding duplicate{.id = LintFinding::Id::duplicate_faces, .of = soup.triangles.size()};
  LintFinding hidden{.id = LintFinding::Id::never_visible_faces, .of = soup.triangles.size()};
  LintFinding unused{.id = LintFinding::Id::unused_vertices, .of = soup.positions.size()};
  std::vector<bool> finite(soup.positions.size());
  for (std::size_t v = 0; v < soup.positions.size(); ++v) {
    finite[v] = is_finite(soup.positions[v]);
    if (!finite[v]) count(non_finite, v);
  }

  std::vector<bool> used(soup.positions.size());
  std::vector<bool> ordinary(soup.triangles.size());  // finite and with an area
  const NeverVisible never_visible(soup);
  for (std::size_t f = 0; f < soup.triangles.size(); ++f) {
    const glm::uvec3& t = soup.triangles[f];
    for (int k = 0; k < 3; ++k) used[t[k]] = true;
    if (!finite[t.x] || !finite[t.y] || !finite[t.z]) continue;
    if (is_degenerate(soup.positions[t.x], soup.positions[t.y], soup.positions[t.z]))
      count(degenerate, f);
    else
      ordinary[f] = true;
    if (never_visible(f)) count(hidden, f);
  }
  for (std::size_t v = 0; v < used.size(); ++v)
    if (!used[v]) count(unused, v);
  find_duplicates(soup, ordinary, duplicate);
  Lint result;
  add_counted(result, {&non_finite, &degenerate, &duplicate, &hidden, &unused});
  add_distance_from_origin(result, bounds(soup));
  return result;
}

}  // namespace tureen
