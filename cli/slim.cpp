#include "cli/slim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/interrupt.hpp"
#include "cli/slim_importance.hpp"
#include "runtime/camera_sets.hpp"
#include "runtime/visibility_count.hpp"
#include "soup/error.hpp"
#include "soup/keep_faces.hpp"
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
/// Halves the ratio of the two to 1.04.
constexpr int bisections = 7;
/// Then the loss is not smooth any more: where each choice between steps depends on those before
/// it, it jumps by 2 % either way. From so far above what bisection found the step comes down by so
/// much at a time, to the first that keeps within the bound.
constexpr double scan_from = 1.06, scan_by = 0.005;
/// Alpha is seen only by where it reaches 1/2: 0, 85, 170, 255 do for trained soups. Where alpha is
/// about 1/2 everywhere, as before training, its edges take more; 1 keeps every alpha near one.
constexpr std::array<std::uint8_t, 3> alpha_steps = {85, 17, 1};

/// Without the faces that neither the recorded cameras nor others show, if asked; each of the
/// others at the smallest level that says the same to half a step of 8 bits. What a finer level
/// would say is coded as nothing anyway; without it there are fewer texels to decode and to draw.
TriangleSoup kept_faces(const gl::Context& context, const Scene& scene,
                        std::span<const Camera> recorded, bool all) {
  const auto interrupted = [](double) { throw_if_interrupted(); };
  const auto& soup = std::get<TriangleSoup>(scene.primitives);
  std::vector<std::uint8_t> keeps(soup.triangles.size(), 1);
  // Without recorded cameras nobody knows where the scene is looked at from.
  if (!all && !scene.cameras.empty()) {
    std::fill(keeps.begin(), keeps.end(), std::uint8_t(0));
    const std::vector<Camera> others =
        hemisphere(subject_of(scene), views_around, {.width = 800, .height = 600});
    for (const std::span<const Camera> views : {recorded, std::span<const Camera>(others)}) {
      const auto pixels = count_visible_pixels(context, soup, scene.origin, views, interrupted);
      for (std::size_t t = 0; t < keeps.size(); ++t)
        if (pixels[t] > 0) keeps[t] = 1;
    }
  }
  TriangleSoup kept = keep_faces(soup, keeps);
  auto& texture = std::get<LatticeTexture>(kept.appearance);
  texture = at_levels(texture, smallest_levels(texture, {}, interrupted), interrupted);
  return kept;
}

class Search {
 public:
  Search(const Scene& scene, const SlimRequest& request)
      : request_(request),
        context_(gl::Context::create(request.context)),
        judge_(context_, scene, request.photographs),
        views_(slim_views(scene, counted_views)),
        soup_(kept_faces(context_, scene, views_, request.keep_unseen)),
        unseen_(std::get<TriangleSoup>(scene.primitives).triangles.size() - soup_.triangles.size()),
        importance_(context_, soup_, scene.origin, views_) {}

  SlimResult run() {
    SlimResult result;
    result.model_db = judge_.model_db();
    result.views = judge_.views();
    find_bits(result);
    const bool found = std::any_of(alpha_steps.begin(), alpha_steps.end(),
                                   [&](std::uint8_t alpha) { return find_step(result, alpha); });
    if (!found)
      throw UsageError(fmt::format(
          "a slim file of this scene loses more than the {:g} dB that are allowed, however fine "
          "its steps",
          request_.max_loss_db));
    result.unseen = unseen_;
    result.seeing_views = views_.size() + views_around;
    result.weighing_views = views_.size();
    result.unseen_texels = importance_.unseen_texels();
    result.kept = std::move(soup_);
    return result;
  }

 private:
  /// The largest step of colour that keeps within the bound; whether there is one.
  bool find_step(SlimResult& result, std::uint8_t alpha_step) {
    const auto fits = [&](double step) {
      progress();
      SlimSoup slim = encode_slim(soup_, {.position_bits = result.position_bits,
                                          .texels = importance_.options(step, alpha_step)});
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
    for (double factor = scan_from; factor > 1 && !fits(low * factor); factor -= scan_by) continue;
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
    // Most scenes take about five tries for the positions, the finest colours at once, and eight
    // of the scan.
    constexpr double usual_tries = 5 + 1 + bisections + 8;
    if (request_.progress) request_.progress(std::min(0.99, double(tries_++) / usual_tries));
  }

  const SlimRequest& request_;
  gl::Context context_;
  SlimJudge judge_;
  std::vector<Camera> views_;
  TriangleSoup soup_;
  std::size_t unseen_;
  SlimImportance importance_;
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
