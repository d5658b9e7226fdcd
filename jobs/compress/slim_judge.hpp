// What a scene loses when its soup is coded slimly: against photographs, or, where there are none,
// against its own pictures.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "runtime/gl/context.hpp"
#include "scene/photographs.hpp"
#include "scene/scene.hpp"

namespace tureen {

struct SlimLoss {
  /// By how much the scene comes less near to its photographs, mean PSNR over the views: measured
  /// where there are photographs, else decibels_lost() of a model of assumed_model_db.
  double db = 0;
  /// Against the scene's own pictures, all views together.
  double render_psnr_db = 100;
};

/// What a loss was measured on: photographs alone, or recorded cameras and views around the scene.
struct SlimViews {
  std::size_t photographs = 0;
  std::size_t cameras = 0;   // of the `recorded` ones
  std::size_t recorded = 0;  // cameras of the scene
  std::size_t around = 0;    // where the scene has fewer than telling_cameras

  bool operator==(const SlimViews&) const = default;
};

/// Called often during long work; throws to end it. May be empty where a declaration says so.
using Cancel = std::function<void()>;

class SlimJudge {
 public:
  /// Above what trained soups reach: better models lose more by the same error.
  static constexpr double assumed_model_db = 32;

  /// Draws the scene from where the photographs were taken, or, where there are none, from
  /// slim_views, up to 24. `context` must outlive the judge and be current. The scene holds a soup
  /// without defect(). Throws UsageError where the scene comes only within hopeless_db of the
  /// photographs, where the loss means nothing, and what drawing throws.
  /// `cancel` may be empty.
  SlimJudge(const gl::Context& context, const Scene& scene, std::span<const Photograph> photographs,
            Cancel cancel = {});

  SlimLoss loss(const TriangleSoup& soup) const;

  /// Mean PSNR of the scene itself against the photographs; assumed_model_db without them.
  double model_db() const { return model_db_; }
  const SlimViews& views() const { return views_; }

 private:
  /// Calls visit(view, picture) for each.
  void draw(const TriangleSoup& soup,
            const std::function<void(std::size_t, const ImageF&)>& visit) const;
  double model_db(const std::vector<double>& squared_errors) const;

  const gl::Context& context_;
  Cancel cancel_;
  glm::dvec3 origin_;
  glm::vec3 background_;
  std::vector<Camera> cameras_;
  std::vector<ImageF> photographs_;  // over the background
  std::vector<ImageF> pictures_;     // of the scene itself
  SlimViews views_;
  double model_db_ = assumed_model_db;
};

/// Fewer recorded cameras do not say where a scene is looked at from: slim files keep one, what
/// trains takes dozens.
inline constexpr std::size_t telling_cameras = 8;

/// A scene that comes only so near to photographs, SlimJudge::model_db, is most likely not theirs:
/// soups before those of another scene came to 5 to 8 dB (four pairs of the example, the fox and
/// lego), soups of 20 steps before their own to 12 and 13.
inline constexpr double hopeless_db = 10;

/// Of the cameras from which the scene was recorded, at most `count`, evenly spread over their
/// order; where they are fewer than telling_cameras also so many, but no more than 64, on the upper
/// half of a sphere around it. None is larger than 800 pixels a side.
std::vector<Camera> slim_views(const Scene& scene, std::span<const Camera> recorded,
                               std::size_t count);

}  // namespace tureen
