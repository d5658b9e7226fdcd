// Searches for the smallest compressed file whose loss stays within a bound (`tureen convert
// --compress`). formats/tureen_glb/tureen_glb_compressed.hpp writes it; docs/compressed-files.md
// describes the method and its results.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "formats/tureen_glb/tureen_glb_compressed.hpp"
#include "jobs/compress/judge.hpp"

namespace tureen {

struct CompressRequest {
  /// Largest loss in decibels, above 0, default 0.1.
  double max_loss_db = 0.1;
  /// Whether faces that no view sees are kept.
  bool keep_unseen = false;
  /// Reference photographs. If empty, the loss is estimated from the scene's own images.
  std::vector<Photograph> photographs = {};
  /// Cameras of other photographs in the same dataset. They are added to a scene with fewer than
  /// telling_cameras recorded cameras, if at least telling_cameras of them show any of it.
  std::vector<Camera> training_cameras = {};
  gl::ContextRequest context = {};
  /// Called with the fraction done, 0..1; may throw to cancel the search.
  std::function<void(double)> progress = {};
};

struct CompressResult {
  /// The scene's soup with only the kept faces.
  TriangleSoup kept;
  CompressedSoup soup;           // the compressed form of `kept`
  std::size_t unseen = 0;        // number of removed faces
  std::size_t seeing_views = 0;  // views that see no removed face, if faces may be removed
  /// Number of texels of the kept faces that no pixel of the `weighing_views` shows. They are
  /// stored with a larger error.
  std::size_t unseen_texels = 0;
  std::size_t weighing_views = 0;
  std::size_t lent_cameras = 0;  // training cameras added to the recorded ones
  CompressLoss loss;
  CompressLoss geometry_loss;  // the part from positions alone
  int position_bits = 0;
  double color_step = 0;  // compressed_basis
  double model_db = 0;    // of the uncompressed scene: CompressJudge::model_db
  CompressViews views;    // the views of the measurement
};

/// The search. If the scene has telling_cameras, including added training cameras, unseen faces are
/// removed. Those are faces that no pixel shows in these cameras (at most 200) and in 64 views from
/// the upper half of a sphere around the scene. With fewer cameras the typical viewpoints are
/// unknown and all faces stay.
///
/// Positions may take a twelfth of the loss and get the fewest bits within it. Faces that a lower
/// level represents to half a step of 8 bits get that level. Bisection and a scan then find the
/// largest step of colour within the bound, with finer alphas if the coarse ones alone lose more.
/// Texels get a larger error if they are rarely visible in the recorded views (given
/// telling_cameras), or if their features hardly change the colour (CompressImportance).
///
/// Throws UsageError if the scene has no lattice texture or no result is within the bound; throws
/// the errors of CompressJudge.
CompressResult compress(const Scene& scene, const CompressRequest& request);

}  // namespace tureen
