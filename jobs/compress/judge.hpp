// The loss from compressing a scene's soup: against photographs, or without photographs against the
// scene's own images.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "runtime/gl/context.hpp"
#include "scene/photographs.hpp"
#include "scene/scene.hpp"

namespace tureen {

struct CompressLoss {
  /// Decrease of the mean PSNR over the views, against photographs. Without photographs,
  /// decibels_lost() for a model of assumed_model_db.
  double db = 0;
  /// PSNR against the scene's own images, all views together.
  double render_psnr_db = 100;
};

/// The views of a measurement: photographs alone, or recorded cameras and views around the scene.
struct CompressViews {
  std::size_t photographs = 0;
  std::size_t cameras = 0;   // number of used recorded cameras
  std::size_t recorded = 0;  // recorded cameras of the scene
  std::size_t around = 0;    // 0 if the scene has min_representative_cameras or more

  bool operator==(const CompressViews&) const = default;
};

/// Called often during long work; throws to cancel. May be empty only where documented.
using Cancel = std::function<void()>;

class CompressJudge {
 public:
  /// Assumed PSNR of a model against photographs. It exceeds the PSNR of trained soups: the same
  /// error costs better models more.
  static constexpr double assumed_model_db = 32;

  /// Draws the scene from the cameras of the photographs, or without photographs from up to 24
  /// compress_views. `context` must be current and outlive the judge. The scene holds a soup
  /// without defect(). Throws UsageError if the scene's PSNR against the photographs is below
  /// hopeless_db, where the loss is meaningless. Throws the errors of drawing. `cancel` may be
  /// empty.
  CompressJudge(const gl::Context& context, const Scene& scene,
                std::span<const Photograph> photographs, Cancel cancel = {});

  CompressLoss loss(const TriangleSoup& soup) const;

  /// Mean PSNR of the original scene against the photographs; without them assumed_model_db.
  double model_db() const { return model_db_; }
  const CompressViews& views() const { return views_; }

 private:
  /// Calls visit(view, image) for each view.
  void draw(const TriangleSoup& soup,
            const std::function<void(std::size_t, const ImageF&)>& visit) const;
  /// Mean squared error against the photograph, over the pixels that its mask does not exclude.
  double photograph_error(std::size_t view, const ImageF& image) const;
  double model_db(const std::vector<double>& squared_errors) const;

  const gl::Context& context_;
  Cancel cancel_;
  glm::dvec3 origin_;
  glm::vec3 background_;
  std::vector<Camera> cameras_;
  std::vector<ImageF> photographs_;                 // composited over the background
  std::vector<std::vector<std::uint8_t>> ignored_;  // Photograph::ignored of each photograph
  std::vector<ImageF> images_;                      // of the original scene
  CompressViews views_;
  double model_db_ = assumed_model_db;
};

/// Smallest number of recorded cameras that represents the typical viewpoints of a scene. A
/// compressed file has only one camera, a training set has dozens.
inline constexpr std::size_t min_representative_cameras = 8;

/// A scene with a lower CompressJudge::model_db most likely does not belong to the photographs.
/// Soups against photographs of another scene have 5 to 8 dB (four pairs of the example, the fox
/// and lego). Soups after 20 training steps have 12 and 13 dB against their own.
inline constexpr double hopeless_db = 10;

/// At most `count` of the recorded cameras, evenly spaced in their order. If `recorded` has fewer
/// than min_representative_cameras, at most 64 views on the upper half of a sphere around the scene
/// fill the list up to `count`. No image side exceeds 800 pixels.
std::vector<Camera> compress_views(const Scene& scene, std::span<const Camera> recorded,
                                   std::size_t count);

}  // namespace tureen
