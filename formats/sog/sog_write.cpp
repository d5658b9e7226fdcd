#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.hpp"
#include "base/json/json_text.hpp"
#include "base/output.hpp"
#include "base/threads/thread_pool.hpp"
#include "formats/archive/zip_writer.hpp"
#include "formats/common/splat_activation.hpp"
#include "formats/sog/codebook.hpp"
#include "formats/sog/palette.hpp"
#include "formats/sog/sog.hpp"
#include "formats/splat/splat_writing.hpp"
#include "image/codecs/webp.hpp"
#include "image/quantise.hpp"
#include "scene/edit/morton_order.hpp"
#include "scene/edit/splat_limit.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

constexpr std::size_t palette_row = 64, largest_palette = 65536;
constexpr int largest_side = 16383;  // of WebP
/// Of libwebp's 0..9: 9 takes ten times as long for 1 % less.
constexpr int webp_effort = 6;

/// sign(x) log(1 + |x|).
double logged(double value) { return std::copysign(std::log1p(std::abs(value)), value); }

Json numbers(const Codebook& codebook) {
  Json list = Json::array();
  for (const float value : codebook) list.push_back(value);
  return list;
}

/// Importance of splats for codebooks and palettes: opacity times area relative to its mean, with a
/// tenth of the mean added, so that small and faint splats, which are many, are not left out.
std::vector<float> weights_of(const SplatKernel& kernel) {
  const std::vector<double> contributions = splat_contributions(kernel);
  double sum = 0;
  for (const double each : contributions) sum += each;
  const double mean = sum > 0 ? sum / double(contributions.size()) : 1;
  std::vector<float> weights(contributions.size());
  for (std::size_t i = 0; i < weights.size(); ++i)
    weights[i] = float(std::min(contributions[i] / mean, 100.0) + 0.1);
  return weights;
}

class SogWriter {
 public:
  explicit SogWriter(StoredGaussians stored) : stored_(std::move(stored)) {
    sort_in_morton_order(stored_.splats);
    auto& gaussians = std::get<Gaussians>(stored_.splats.kernel);
    for (std::size_t i = 0; i < count(); ++i)
      order_axes(gaussians.scales[i], gaussians.rotations[i], gaussians.flat);
    // Nearly a square, as other programs write it.
    const double side = std::sqrt(double(count()));
    width_ = int(std::ceil(side / 4)) * 4;
    height_ = int((count() + std::size_t(width_) - 1) / std::size_t(width_) + 3) / 4 * 4;
    if (width_ > largest_side || height_ > largest_side)
      throw UsageError("SOG holds at most 268 million splats, and this scene has " +
                       std::to_string(count()));
    weights_ = weights_of(stored_.splats.kernel);
  }

  void write(const std::filesystem::path& path) {
    Json meta = {{"version", 2}, {"asset", {{"generator", "Tureen"}}}, {"count", count()}};
    if (stored_.profile == "mip") meta.update({{"antialias", true}, {"model", "antialiased"}});
    if (stored_.profile == "2dgs") meta["model"] = "2dgs";
    meta["means"] = write_centers();
    meta["scales"] = write_scales();
    meta["quats"] = write_rotations();
    meta["sh0"] = write_colors();
    if (stored_.splats.color.degree > 0) meta["shN"] = write_harmonics();
    std::vector<std::vector<std::byte>> packed(images_.size());
    ThreadPool().run(images_.size(), [&](std::size_t i) {
      packed[i] = encode_webp(images_[i].second, webp_effort);
    });
    Output output(path);
    ZipWriter zip(output);
    const std::string text = json_text(meta, -1);
    zip.add("meta.json", std::as_bytes(std::span(text)));
    for (std::size_t i = 0; i < images_.size(); ++i) zip.add(images_[i].first, packed[i]);
    zip.finish();
    output.commit();
  }

 private:
  std::size_t count() const { return tureen::count(stored_.splats); }
  const Gaussians& gaussians() const { return stored_.gaussians(); }

  Image8& add_image(const char* name, int width, int height) {
    return images_.emplace_back(name, Image8(width, height, glm::u8vec4(0, 0, 0, 255))).second;
  }
  Image8& add_image(const char* name) { return add_image(name, width_, height_); }

  Json write_centers() {
    glm::dvec3 low(0), high(0);
    std::vector<glm::dvec3> centers(count());
    for (std::size_t i = 0; i < count(); ++i) {
      for (int k = 0; k < 3; ++k) centers[i][k] = logged(double(gaussians().centers[i][k]));
      low = i == 0 ? centers[i] : glm::min(low, centers[i]);
      high = i == 0 ? centers[i] : glm::max(high, centers[i]);
    }
    Image8 low_bytes(width_, height_, glm::u8vec4(0, 0, 0, 255)), high_bytes = low_bytes;
    for (std::size_t i = 0; i < count(); ++i)
      for (int k = 0; k < 3; ++k) {
        const double range = high[k] - low[k];
        const double fraction = range > 0 ? (centers[i][k] - low[k]) / range : 0;
        const auto fixed = unsigned(std::lround(65535 * fraction));
        low_bytes.pixels[i][k] = std::uint8_t(fixed & 255);
        high_bytes.pixels[i][k] = std::uint8_t(fixed >> 8);
      }
    images_.emplace_back("means_l.webp", std::move(low_bytes));
    images_.emplace_back("means_u.webp", std::move(high_bytes));
    return {{"mins", {low.x, low.y, low.z}},
            {"maxs", {high.x, high.y, high.z}},
            {"files", {"means_l.webp", "means_u.webp"}}};
  }

  Json write_scales() {
    std::vector<float> logs(3 * count());
    for (std::size_t i = 0; i < logs.size(); ++i) {
      const float scale = gaussians().scales[i / 3][int(i % 3)];
      logs[i] = std::max(stored_scale(double(scale)), least_log());
    }
    const Codebook codebook = best_codebook(logs, weights_, 3);
    Image8& image = add_image("scales.webp");
    for (std::size_t i = 0; i < logs.size(); ++i)
      image.pixels[i / 3][int(i % 3)] = nearest_in(codebook, logs[i]);
    return {{"codebook", numbers(codebook)}, {"files", {"scales.webp"}}};
  }

  Json write_rotations() {
    Image8& image = add_image("quats.webp");
    for (std::size_t i = 0; i < count(); ++i) {
      const glm::quat& q = gaussians().rotations[i];
      // order_axes() made w the largest.
      const std::array<float, 3> parts{q.x, q.y, q.z};
      for (int k = 0; k < 3; ++k)
        image.pixels[i][k] =
            std::uint8_t(std::lround(255 * (double(parts[std::size_t(k)]) * std::sqrt(0.5) + 0.5)));
      image.pixels[i].a = 252;
    }
    return {{"files", {"quats.webp"}}};
  }

  Json write_colors() {
    const std::size_t each = coefficients_per_splat(stored_.splats.color);
    std::vector<float> values(3 * count());
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = stored_.splats.color.coefficients[i / 3 * each][int(i % 3)];
    const Codebook codebook = best_codebook(values, weights_, 3);
    Image8& image = add_image("sh0.webp");
    for (std::size_t i = 0; i < values.size(); ++i)
      image.pixels[i / 3][int(i % 3)] = nearest_in(codebook, values[i]);
    for (std::size_t i = 0; i < count(); ++i)
      image.pixels[i].a = quantised_unit(gaussians().opacity[i]);
    return {{"codebook", numbers(codebook)}, {"files", {"sh0.webp"}}};
  }

  Json write_harmonics() {
    const SplatColor& color = stored_.splats.color;
    const std::size_t all = coefficients_per_splat(color), each = all - 1, dimensions = 3 * each;
    std::vector<float> rows(count() * dimensions);
    for (std::size_t i = 0; i < count(); ++i)
      std::copy_n(&color.coefficients[i * all + 1].x, dimensions, &rows[i * dimensions]);
    std::size_t size = largest_palette;
    while (size > 64 && size > count()) size /= 2;
    Palette palette(rows, dimensions, weights_, size);
    std::vector<float> entries(palette.entries().begin(), palette.entries().end());
    std::vector<float> uses(palette.count(), 0.01f);  // an entry without splats counts a little
    for (std::size_t i = 0; i < count(); ++i) uses[palette.indices()[i]] += weights_[i];
    const Codebook codebook = best_codebook(entries, uses, dimensions);
    Image8& image = add_image("shN_centroids.webp", int(palette_row * each),
                              int((palette.count() + palette_row - 1) / palette_row));
    for (std::size_t k = 0; k < entries.size(); ++k) {
      const std::uint8_t byte = nearest_in(codebook, entries[k]);
      // A row of the image has 64 entries one after the other, so pixels follow each other.
      image.pixels[k / 3][int(k % 3)] = byte;
      entries[k] = codebook[byte];
    }
    palette.replace_entries(std::move(entries));
    Image8& indices = add_image("shN_labels.webp");
    for (std::size_t i = 0; i < count(); ++i) {
      const std::uint32_t index = palette.indices()[i];
      indices.pixels[i] = glm::u8vec4(index & 255, index >> 8, 0, 255);
    }
    return {{"count", palette.count()},
            {"bands", color.degree},
            {"codebook", numbers(codebook)},
            {"files", {"shN_centroids.webp", "shN_labels.webp"}}};
  }

  /// Logarithm of the smallest scale: below it, a splat is invisible within the scene's size, and
  /// would only widen the range.
  static float least_log() { return -20.0f; }

  StoredGaussians stored_;
  std::vector<float> weights_;
  int width_ = 0, height_ = 0;
  std::vector<std::pair<const char*, Image8>> images_;
};

}  // namespace

bool fits_sog(const Scene& scene) { return holds_gaussians(scene); }

std::vector<std::string> write_sog(const Scene& scene, const std::filesystem::path& path) {
  StoredGaussians stored = gaussians_for(scene, {.name = "SOG", .max_degree = 3, .has_flat = true});
  std::vector<std::string> lost = std::move(stored.lost);
  SogWriter(std::move(stored)).write(path);
  return lost;
}

}  // namespace tureen
