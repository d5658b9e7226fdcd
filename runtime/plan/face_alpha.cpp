#include "runtime/plan/face_alpha.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "runtime/plan/texel_ranges.hpp"
#include "scene/lattice.hpp"

namespace tureen {

namespace {

FaceAlpha classify(float lowest, float highest, float threshold) {
  if (lowest >= threshold) return FaceAlpha::opaque;
  // Negated so that NaN counts as transparent, as in the alpha test.
  if (!(highest >= threshold)) return FaceAlpha::transparent;
  return FaceAlpha::cut_out;
}

/// The smallest and the largest of a face's alphas so far.
struct AlphaRange {
  float low, high;
  bool has_nan = false;

  explicit AlphaRange(float first) : low(first), high(first), has_nan(std::isnan(first)) {}
  void add(float alpha) {
    low = std::min(low, alpha);
    high = std::max(high, alpha);
    has_nan = has_nan || std::isnan(alpha);
  }
  /// Whether further alphas change nothing.
  bool is_cut_out() const { return low < alpha_threshold && high >= alpha_threshold; }
  /// Comparisons ignore NaN. Fragments that interpolate a NaN do not exist, but others may, so the
  /// face needs the test.
  FaceAlpha classified() const {
    return has_nan ? FaceAlpha::cut_out : classify(low, high, alpha_threshold);
  }
};

/// Counts the texels of an image's channel that reach a threshold, for any rectangle in constant
/// time.
class ReachingCounts {
 public:
  ReachingCounts(const Image8& image, int channel, float factor, float threshold)
      : stride_(std::size_t(image.width) + 1), sums_(stride_ * (std::size_t(image.height) + 1), 0) {
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        const bool reaches = factor * (float(image.at(x, y)[channel]) / 255.0f) >= threshold;
        sums_[index(x + 1, y + 1)] = sums_[index(x, y + 1)] + sums_[index(x + 1, y)] -
                                     sums_[index(x, y)] + (reaches ? 1u : 0u);
      }
  }
  /// Over columns [x0, x1] and rows [y0, y1].
  std::uint32_t over(int x0, int y0, int x1, int y1) const {
    return sums_[index(x1 + 1, y1 + 1)] - sums_[index(x0, y1 + 1)] - sums_[index(x1 + 1, y0)] +
           sums_[index(x0, y0)];
  }

 private:
  std::size_t index(int x, int y) const { return std::size_t(y) * stride_ + std::size_t(x); }
  std::size_t stride_;
  std::vector<std::uint32_t> sums_;
};

struct Classify {
  const TriangleSoup& soup;
  std::vector<FaceAlpha>& result;

  void operator()(const FaceColors& colors) const {
    for (std::size_t t = 0; t < result.size(); ++t)
      result[t] = classify(colors.rgba[t].a, colors.rgba[t].a, alpha_threshold);
  }

  void operator()(const VertexColors& colors) const {
    for (std::size_t t = 0; t < result.size(); ++t) {
      const glm::uvec3& v = soup.triangles[t];
      AlphaRange range(colors.rgba[v.x].a);
      range.add(colors.rgba[v.y].a);
      range.add(colors.rgba[v.z].a);
      result[t] = range.classified();
    }
  }

  void operator()(const Harmonics&) const {
    std::fill(result.begin(), result.end(), FaceAlpha::opaque);
  }

  void operator()(const LatticeTexture& texture) const {
    std::visit([&](const auto& values) { lattice(texture, values); }, texture.texels);
  }

  template <class Value>
  void lattice(const LatticeTexture& texture, const std::vector<Value>& values) const {
    for (std::size_t t = 0; t < result.size(); ++t) {
      const LatticePatch& patch = texture.patches[t];
      result[t] = of_texels(&values[std::size_t(patch.first_texel) * LatticeTexture::channels],
                            lattice::texel_count(int(patch.level)));
    }
  }

  static FaceAlpha of_texels(const std::uint8_t* texels, std::uint32_t count) {
    TexelRanges<std::uint8_t> ranges;
    ranges.add(texels, count);
    const auto alpha = [](std::uint8_t value) { return float(value) * scale_of<std::uint8_t>; };
    return classify(alpha(ranges.low(LatticeTexture::features)),
                    alpha(ranges.high(LatticeTexture::features)), alpha_threshold);
  }

  static FaceAlpha of_texels(const float* texels, std::uint32_t count) {
    const float* alpha = texels + LatticeTexture::features;
    AlphaRange range(*alpha);
    for (std::uint32_t k = 1; k < count && !range.is_cut_out(); ++k)
      range.add(*(alpha += LatticeTexture::channels));
    return range.classified();
  }

  void operator()(const UvTextures& textures) const {
    // Material by material, so that only the counts of one image are in memory.
    std::vector<std::vector<std::uint32_t>> faces(textures.materials.size());
    for (std::uint32_t t = 0; t < result.size(); ++t)
      faces[textures.material_of_face[t]].push_back(t);
    for (std::size_t m = 0; m < textures.materials.size(); ++m) {
      if (faces[m].empty()) continue;
      const UvMaterial& material = textures.materials[m];
      const bool always = !(material.mask_threshold > 0.0f);
      const bool tinted = !textures.vertex_rgba.empty();
      if (always || material.images.empty() || tinted) {
        const float value = material.factor[material.mask_channel];
        // A tint varies over the face, so the face needs the test.
        const FaceAlpha alpha = always   ? FaceAlpha::opaque
                                : tinted ? FaceAlpha::cut_out
                                         : classify(value, value, material.mask_threshold);
        for (const std::uint32_t t : faces[m]) result[t] = alpha;
        continue;
      }
      const Image8& image = textures.images[material.images[0]];
      const float factor = textures.mlp ? 1.0f : material.factor[material.mask_channel];
      const ReachingCounts counts(image, material.mask_channel, factor, material.mask_threshold);
      for (const std::uint32_t t : faces[m]) result[t] = within_image(textures, image, counts, t);
    }
  }

  FaceAlpha within_image(const UvTextures& textures, const Image8& image,
                         const ReachingCounts& counts, std::size_t t) const {
    const glm::uvec3& v = soup.triangles[t];
    const glm::vec2 a = textures.uv[v.x], b = textures.uv[v.y], c = textures.uv[v.z];
    const glm::vec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
    // Faces with wrapped coordinates need the test. Negated so that NaN needs it too.
    if (!(low.x >= 0 && low.y >= 0 && high.x <= 1 && high.y <= 1)) return FaceAlpha::cut_out;
    // One more texel on each side, for bilinear neighbours and the rounding of the interpolation.
    const int x0 = std::max(int(low.x * float(image.width)) - 1, 0);
    const int y0 = std::max(int(low.y * float(image.height)) - 1, 0);
    const int x1 = std::min(int(high.x * float(image.width)) + 1, image.width - 1);
    const int y1 = std::min(int(high.y * float(image.height)) + 1, image.height - 1);
    // At the border a sample may wrap to the other side of the image.
    const UvMaterial& material = textures.materials[textures.material_of_face[t]];
    const bool wraps =
        material.wrap_u != UvMaterial::Wrap::clamp || material.wrap_v != UvMaterial::Wrap::clamp;
    if (wraps && (x0 == 0 || y0 == 0 || x1 == image.width - 1 || y1 == image.height - 1))
      return FaceAlpha::cut_out;
    const std::uint32_t reaching = counts.over(x0, y0, x1, y1);
    if (reaching == 0) return FaceAlpha::transparent;
    const std::uint32_t all = std::uint32_t(x1 - x0 + 1) * std::uint32_t(y1 - y0 + 1);
    return reaching == all ? FaceAlpha::opaque : FaceAlpha::cut_out;
  }
};

}  // namespace

std::vector<FaceAlpha> classify_alpha(const TriangleSoup& soup) {
  std::vector<FaceAlpha> result(soup.triangles.size(), FaceAlpha::cut_out);
  std::visit(Classify{soup, result}, soup.appearance);
  return result;
}

bool drawable(const TriangleSoup& soup, std::uint32_t face) {
  const glm::uvec3& t = soup.triangles[face];
  const glm::dvec3 a = soup.positions[t.x], b = soup.positions[t.y], c = soup.positions[t.z];
  const glm::dvec3 ab = b - a, ac = c - a, bc = c - b;
  const glm::dvec3 cross = glm::cross(ab, ac);
  const double longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
  // An area below 1e-12 of the longest edge squared is rounding. This form of the comparison also
  // rejects NaN, which infinite corners give.
  return glm::length(cross) > 1e-12 * longest;
}

}  // namespace tureen
