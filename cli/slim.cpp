#include "cli/slim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/matrix.hpp>

#include "cli/interrupt.hpp"
#include "runtime/camera_sets.hpp"
#include "runtime/renderer.hpp"
#include "soup/error.hpp"
#include "soup/feature_sensitivity.hpp"
#include "soup/lattice_levels.hpp"

namespace tureen::cli {

namespace {

constexpr std::size_t counted_views = 200;
constexpr int views_around = 64;
constexpr int fewest_bits = 10;
/// Of the loss, for the positions at most. A bit of theirs takes less than texels save by what it
/// leaves them of the loss: against a quarter of it, 15,000 triangles of lego and of the fox are
/// 2.6 % smaller, with the finer bisection.
constexpr double geometry_share = 0.08;
/// 255ths of colour. Below the least the rounding to bytes is all that is left; beyond the largest
/// no scene is worth looking at.
constexpr double least_step = 0.5, largest_step = 64;
/// Halves the ratio of the two to 1.005: a step's bytes and loss follow within about as much.
constexpr int bisections = 10;
/// Alpha is seen only by where it reaches 1/2: 0, 85, 170, 255 do for trained soups. Where alpha is
/// about 1/2 everywhere, as before training, its edges take more; 1 keeps every alpha near one.
constexpr std::array<std::uint8_t, 3> alpha_steps = {85, 17, 1};
/// A dead zone: misses below three quarters of a step become none. Of 0.18, 0.25, 0.33 and 0.4 this
/// gave the fewest bytes at the same loss (lego and the fox), by 0.2 to 3 %.
constexpr double rounding = 0.25;
/// How much of what a face's pixels and sensitivity differ from the mean its step follows. 1/2 each
/// would be right where every value took bits; most are zero. Against 0.3 this saves 0.5 % of the
/// bytes at the same loss (lego and the fox), against 0.15 some 3 %.
constexpr double follow = 0.4;

std::vector<std::uint64_t> count_pixels(const gl::Context& context, const TriangleSoup& soup,
                                        glm::dvec3 origin, const std::vector<Camera>& views) {
  std::vector<std::uint64_t> pixels(soup.triangles.size(), 0);
  Renderer renderer(context, soup, origin, {.plan = {.site = ShadingSite::deferred}});
  for (const Camera& view : views) {
    throw_if_interrupted();
    renderer.draw(view);
    for (const std::uint32_t face : renderer.read_faces())
      if (face != no_face) ++pixels[face];
  }
  return pixels;
}

double mean(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return values.empty() ? 0 : sum / double(values.size());
}

/// The index of the multiplier nearest to `wanted`, in proportion.
std::uint8_t nearest_multiplier(double wanted) {
  std::size_t best = 0;
  const auto away = [&](std::size_t i) {
    return std::abs(std::log(slim_multipliers[i] / 4.0 / wanted));
  };
  for (std::size_t i = 1; i < slim_multipliers.size(); ++i)
    if (away(i) < away(best)) best = i;
  return std::uint8_t(best);
}

/// The soup without the faces whose entry is 0, and those entries. It has a lattice texture.
struct Kept {
  TriangleSoup soup;
  std::vector<std::uint64_t> pixels;
};

Kept keep_seen(const TriangleSoup& soup, const std::vector<std::uint64_t>& pixels,
               const std::vector<bool>& seen) {
  const auto& texture = std::get<LatticeTexture>(soup.appearance);
  Kept kept{soup, {}};
  kept.soup.triangles.clear();
  auto& patches = std::get<LatticeTexture>(kept.soup.appearance).patches;
  patches.clear();
  // Vertices and texels that nothing uses any longer are not coded.
  for (std::size_t t = 0; t < soup.triangles.size(); ++t) {
    if (!seen[t]) continue;
    kept.soup.triangles.push_back(soup.triangles[t]);
    patches.push_back(texture.patches[t]);
    kept.pixels.push_back(pixels[t]);
  }
  return kept;
}

/// Each face at the smallest level that says the same to half a step of 8 bits. What a finer level
/// would say is coded as nothing anyway; without it there are fewer texels to decode and to draw.
void lower_levels(TriangleSoup& soup) {
  auto& texture = std::get<LatticeTexture>(soup.appearance);
  const LevelProgress interrupted = [](double) { throw_if_interrupted(); };
  texture = at_levels(texture, smallest_levels(texture, {}, interrupted), interrupted);
}

/// The faces to keep, with the pixels that each has in the recorded views.
Kept seen_faces(const gl::Context& context, const Scene& scene, bool all) {
  const auto& soup = std::get<TriangleSoup>(scene.primitives);
  const auto pixels = count_pixels(context, soup, scene.origin, slim_views(scene, counted_views));
  std::vector<bool> seen(pixels.size(), true);
  if (!all && !scene.cameras.empty()) {
    const auto around =
        count_pixels(context, soup, scene.origin,
                     hemisphere(subject_of(scene), views_around, {.width = 800, .height = 600}));
    for (std::size_t t = 0; t < seen.size(); ++t) seen[t] = pixels[t] + around[t] > 0;
  }
  return keep_seen(soup, pixels, seen);
}

/// What does not change while the step does.
class Coarseness {
 public:
  Coarseness(const Kept& kept, const std::vector<Camera>& views, glm::dvec3 origin)
      : soup_(kept.soup), texture_(std::get<LatticeTexture>(soup_.appearance)) {
    std::vector<glm::dvec3> eyes;
    for (const Camera& view : views)
      eyes.push_back(glm::dvec3(glm::inverse(view.view_from_world)[3]) - origin);
    sensitivity_ = mean_sensitivity(soup_, eyes);
    // A face that no recorded view shows may show in others: like a quarter of a pixel.
    std::vector<double> shown;
    for (const std::uint64_t count : kept.pixels) shown.push_back(std::max(double(count), 0.25));
    const std::vector<double> moved = face_sensitivity(soup_, eyes, steps(basis(8)));
    const double mean_shown = mean(shown), mean_moved = mean(moved);
    for (std::size_t t = 0; t < shown.size(); ++t) {
      // Faces of one colour, whatever their features: 1/1000 of the mean is none.
      const double sees = mean_moved > 0 ? std::max(moved[t] / mean_moved, 1e-3) : 1;
      of_face_.push_back(nearest_multiplier(1 / std::pow(shown[t] / mean_shown * sees, follow)));
    }
  }

  SlimTexelOptions options(double step, std::uint8_t alpha_step) const {
    return {.basis = basis(step),
            .feature_step = slim_fraction,
            .alpha_step = alpha_step,
            .coarseness = of_face_,
            .rounding = rounding};
  }

 private:
  using Features = std::array<double, LatticeTexture::features>;

  SlimBasis basis(double step) const { return slim_basis(texture_, sensitivity_, step); }

  /// What a step along each axis of the basis changes, features in [0, 1].
  static std::vector<Features> steps(const SlimBasis& basis) {
    std::vector<Features> result(basis.rows.size());
    for (std::size_t axis = 0; axis < result.size(); ++axis)
      for (std::size_t f = 0; f < basis.rows.size(); ++f)
        result[axis][f] = double(basis.rows[f][axis]) / 65536.0 * slim_fraction / 255.0;
    return result;
  }

  const TriangleSoup& soup_;
  const LatticeTexture& texture_;
  FeatureMatrix sensitivity_{};
  std::vector<std::uint8_t> of_face_;
};

class Search {
 public:
  Search(const Scene& scene, const SlimRequest& request)
      : request_(request),
        context_(gl::Context::create(request.context)),
        judge_(context_, scene, request.photographs),
        kept_(seen_faces(context_, scene, request.keep_unseen)),
        soup_(kept_.soup),
        unseen_(std::get<TriangleSoup>(scene.primitives).triangles.size() - soup_.triangles.size()),
        views_(slim_views(scene, counted_views)),
        coarseness_(kept_, views_, scene.origin) {}

  SlimResult run() {
    SlimResult result;
    result.model_db = judge_.model_db();
    result.views = judge_.views();
    find_bits(result);
    lower_levels(kept_.soup);
    const bool found = std::any_of(alpha_steps.begin(), alpha_steps.end(),
                                   [&](std::uint8_t alpha) { return find_step(result, alpha); });
    if (!found)
      throw UsageError(fmt::format(
          "a slim file of this scene loses more than the {:g} dB that are allowed, however fine "
          "its steps",
          request_.max_loss_db));
    result.unseen = unseen_;
    result.seeing_views = views_.size() + views_around;
    result.kept = std::move(kept_.soup);
    return result;
  }

 private:
  /// The largest step of colour that keeps within the bound; whether there is one.
  bool find_step(SlimResult& result, std::uint8_t alpha_step) {
    const auto fits = [&](double step) {
      progress();
      SlimSoup slim = encode_slim(soup_, {.position_bits = result.position_bits,
                                          .texels = coarseness_.options(step, alpha_step)});
      const SlimLoss loss = judge_.loss(decode_slim(slim, soup_));
      if (loss.db > request_.max_loss_db) return false;
      result.color_step = step;
      result.loss = loss;
      result.soup = std::move(slim);
      return true;
    };
    if (!fits(least_step)) return false;
    double low = least_step, high = largest_step;
    for (int i = 0; i < bisections; ++i) {
      const double step = std::sqrt(low * high);
      (fits(step) ? low : high) = step;
    }
    return true;
  }

  /// The texels as they are, on positions of so many bits.
  SlimLoss geometry_loss(int bits) {
    const auto bytes = encode_slim_geometry({soup_.positions, soup_.triangles}, bits);
    TriangleSoup moved = soup_;
    SlimGeometry geometry = decode_slim_geometry(bytes, used_vertices(soup_.triangles),
                                                 soup_.triangles.size(), "slim geometry");
    moved.positions = std::move(geometry.positions);
    moved.triangles = std::move(geometry.triangles);
    return judge_.loss(moved);
  }

  void find_bits(SlimResult& result) {
    for (int bits = fewest_bits; bits <= max_slim_bits; ++bits) {
      progress();
      result.position_bits = bits;
      result.geometry_loss = geometry_loss(bits);
      if (result.geometry_loss.db <= geometry_share * request_.max_loss_db) return;
    }
  }

  void progress() {
    // Most scenes take about five tries for the positions, and the finest colours at once.
    if (request_.progress) request_.progress(std::min(0.99, double(tries_++) / (bisections + 6.0)));
  }

  const SlimRequest& request_;
  gl::Context context_;
  SlimJudge judge_;
  Kept kept_;
  const TriangleSoup& soup_;
  std::size_t unseen_;
  std::vector<Camera> views_;
  Coarseness coarseness_;
  int tries_ = 0;
};

}  // namespace

SlimResult slim(const Scene& scene, const SlimRequest& request) {
  const auto* soup = std::get_if<TriangleSoup>(&scene.primitives);
  if (!soup || !std::holds_alternative<LatticeTexture>(soup->appearance))
    throw UsageError("a slim file holds lattice textures only; this scene has " +
                     std::string(soup ? appearance_name(soup->appearance) : "soft triangles"));
  return Search(scene, request).run();
}

}  // namespace tureen::cli
