#include "jobs/compress/compress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "base/error.hpp"
#include "camera/camera_sets.hpp"
#include "jobs/compress/importance.hpp"
#include "jobs/visibility/visibility_count.hpp"
#include "scene/edit/keep_faces.hpp"
#include "scene/edit/lattice_levels.hpp"

namespace tureen {

namespace {

constexpr std::size_t counted_views = 200;
constexpr int importance_views = 64;
constexpr int fewest_bits = 10;
/// Largest loss from positions, as a fraction of max_loss_db. A further bit per position costs less
/// than texels save with the loss that it frees. With 15,000 triangles of lego or the fox, files
/// are about 2 % smaller than with a quarter.
constexpr double geometry_share = 0.08;
/// Range of the step of colour, in 1/255. Below it, only the rounding to bytes is left; above it,
/// every scene is unusable.
constexpr double min_step = 0.5, largest_step = 64;
/// Narrows the ratio of the two bounds to 1.04.
constexpr int bisections = 7;
/// At this scale the loss is not monotonic: each rounding depends on earlier ones, so the loss
/// jumps by 2 % in either direction. A scan therefore starts a few steps above the bisected step
/// and takes the first step within the bound.
constexpr int scan_steps = 12;
constexpr double scan_by = 0.005;
/// Alpha is visible only through its edge at 1/2, so trained soups need only 0, 85, 170 and 255. If
/// alpha is about 1/2 everywhere, as before training, edges need finer steps; 1 keeps every alpha
/// near an edge.
constexpr std::array<std::uint8_t, 3> alpha_steps = {85, 17, 1};

/// The soup without the faces that no view shows.
TriangleSoup seen_faces(const gl::Context& context, const Scene& scene,
                        std::span<const Camera> views, const Cancel& cancel) {
  const auto& soup = only_soup(scene);
  const auto pixels = count_visible_pixels(context, soup, origin_of(only_layer(scene)), views,
                                           [&](double) { cancel(); });
  std::vector<std::uint8_t> keeps;
  for (const std::uint64_t count : pixels) keeps.push_back(count > 0);
  return keep_faces(soup, keeps);
}

/// The views that decide which faces are removed: those of the weights, and more around the scene.
std::vector<Camera> all_views(const Scene& scene, const std::vector<Camera>& views) {
  std::vector<Camera> all = views;
  const auto around =
      hemisphere(subject_of(scene), importance_views, {.width = 800, .height = 600});
  all.insert(all.end(), around.begin(), around.end());
  return all;
}

/// Reduces each face to the smallest level with an error below half a step of 8 bits. The details
/// of finer levels would be coded as zero anyway. Without them there are fewer texels to decode and
/// draw.
void lower_levels(TriangleSoup& soup, const Cancel& cancel) {
  auto& texture = std::get<LatticeTexture>(soup.appearance);
  const LevelProgress progress = [&](double) { cancel(); };
  texture = at_levels(texture, smallest_levels(texture, {}, progress), progress);
}

/// The scene's cameras, then the training cameras that are added. The first one is also the camera
/// in the compressed file.
std::vector<Camera> recorded_cameras(const gl::Context& context, const Scene& scene,
                                     const CompressRequest& request, const Cancel& cancel) {
  std::vector<Camera> cameras = scene.cameras;
  if (cameras.size() >= min_representative_cameras ||
      request.training_cameras.size() < min_representative_cameras)
    return cameras;
  // Cameras that show nothing of the scene, e.g. with damaged poses, would favour removing all
  // faces.
  const std::vector<Camera>& others = request.training_cameras;
  const auto pixels =
      count_covered_pixels(context, only_soup(scene), origin_of(only_layer(scene)),
                           compress_views(scene, others, others.size()), [&](double) { cancel(); });
  std::vector<Camera> showing;
  for (std::size_t i = 0; i < others.size(); ++i)
    if (pixels[i] > 0) showing.push_back(others[i]);
  if (showing.size() >= min_representative_cameras)
    cameras.insert(cameras.end(), showing.begin(), showing.end());
  return cameras;
}

class Search {
 public:
  Search(const Scene& scene, const CompressRequest& request)
      : request_(request),
        cancel_([this] { report_progress(); }),
        origin_(origin_of(only_layer(scene))),
        context_(gl::Context::create(request.context)),
        judge_(context_, scene, request.photographs, cancel_),
        recorded_(recorded_cameras(context_, scene, request, cancel_)),
        lent_(recorded_.size() - scene.cameras.size()),
        views_(compress_views(scene, recorded_, counted_views)),
        soup_(only_soup(scene)) {
    // With fewer cameras the typical viewpoints are unknown, so all faces are kept.
    if (request.keep_unseen || recorded_.size() < min_representative_cameras) return;
    const std::vector<Camera> all = all_views(scene, views_);
    const std::size_t faces = soup_.triangles.size();
    soup_ = seen_faces(context_, scene, all, cancel_);
    unseen_ = faces - soup_.triangles.size();
    seeing_views_ = all.size();
  }

  CompressResult run() {
    CompressResult result;
    result.model_db = judge_.model_db();
    result.views = judge_.views();
    find_bits(result);
    lower_levels(soup_, cancel_);
    const CompressImportance importance(context_, soup_, origin_, views_,
                                        recorded_.size() >= min_representative_cameras, cancel_);
    const bool found = std::any_of(alpha_steps.begin(), alpha_steps.end(), [&](std::uint8_t alpha) {
      return find_step(result, importance, alpha);
    });
    if (!found)
      throw UsageError(
          fmt::format("a compressed file of this scene exceeds the allowed loss of {:g} dB: the "
                      "finest steps lose {:.4f} dB",
                      request_.max_loss_db, min_loss_));
    result.unseen = unseen_;
    result.seeing_views = seeing_views_;
    result.weighing_views = views_.size();
    result.lent_cameras = lent_;
    result.unseen_texels = importance.unseen_texels();
    result.kept = std::move(soup_);
    return result;
  }

 private:
  /// Finds the largest step of colour within the bound. Returns whether there is one.
  bool find_step(CompressResult& result, const CompressImportance& importance,
                 std::uint8_t alpha_step) {
    const auto fits = [&](double step, bool bits_have_a_price = true) {
      next_try();
      CompressedSoup compressed = encode_compressed(
          soup_, {.position_bits = result.position_bits,
                  .texels = importance.options(step, alpha_step, bits_have_a_price)});
      const CompressLoss loss = judge_.loss(decode_compressed(compressed, soup_));
      min_loss_ = std::min(min_loss_, loss.db);
      if (loss.db > request_.max_loss_db) return false;
      result.color_step = step;
      result.loss = loss;
      result.soup = std::move(compressed);
      return true;
    };
    // The smallest possible loss at this alpha step.
    if (!fits(min_step, false)) return false;
    double low = min_step, high = largest_step;
    for (int i = 0; i < bisections; ++i) {
      const double step = std::sqrt(low * high);
      (fits(step) ? low : high) = step;
    }
    for (int i = scan_steps; i > 0 && !fits(low * (1 + i * scan_by)); --i) continue;
    return true;
  }

  /// The loss with positions of `bits` bits and unchanged texels.
  CompressLoss geometry_loss(int bits) {
    const auto bytes = encode_compressed_geometry({soup_.positions, soup_.triangles}, bits);
    TriangleSoup moved = soup_;
    CompressedGeometry geometry = decode_compressed_geometry(
        bytes, used_vertices(soup_.triangles), soup_.triangles.size(), "compressed geometry");
    moved.positions = std::move(geometry.positions);
    moved.triangles = std::move(geometry.triangles);
    moved.normals.clear();  // compressed files have none
    return judge_.loss(moved);
  }

  void find_bits(CompressResult& result) {
    for (int bits = fewest_bits; bits <= max_compressed_bits; ++bits) {
      next_try();
      result.position_bits = bits;
      result.geometry_loss = geometry_loss(bits);
      if (result.geometry_loss.db <= geometry_share * request_.max_loss_db) return;
    }
  }

  void next_try() {
    ++tries_;
    report_progress();
  }

  void report_progress() const {
    // Most scenes need about five tries for positions, one for the finest colours, the bisections
    // and eight of the scan.
    constexpr double usual_tries = 5 + 1 + bisections + 8;
    const int done = std::max(tries_ - 1, 0);
    if (request_.progress) request_.progress(std::min(0.99, done / usual_tries));
  }

  const CompressRequest& request_;
  int tries_ = 0;
  const Cancel cancel_;  // reports progress, which may throw
  const glm::dvec3 origin_;
  gl::Context context_;
  CompressJudge judge_;
  const std::vector<Camera> recorded_;
  const std::size_t lent_;
  std::vector<Camera> views_;
  TriangleSoup soup_;
  std::size_t unseen_ = 0, seeing_views_ = 0;
  double min_loss_ = std::numeric_limits<double>::infinity();
};

}  // namespace

CompressResult compress(const Scene& scene, const CompressRequest& request) {
  const auto* soup = std::get_if<TriangleSoup>(&only_layer(scene).primitives);
  if (!soup || !std::holds_alternative<LatticeTexture>(soup->appearance))
    throw UsageError("a compressed file supports only lattice textures; this scene has " +
                     std::string(soup ? appearance_name(soup->appearance) : "splats"));
  return Search(scene, request).run();
}

}  // namespace tureen
