// Searches for the smallest compressed file whose loss stays within a bound (`tureen convert
// --compress`). formats/tureen_glb/tureen_glb_compressed.hpp writes it; docs/compressed-files.md
// describes the method and its results.
#pragma once

#include <functional>
#include <vector>

#include "formats/tureen_glb/tureen_glb_compressed.hpp"
#include "jobs/compress/judge.hpp"

namespace tureen {

struct CompressRequest {
  /// Largest loss in decibels, above 0, default 0.1.
  double max_loss_db = 0.1;
  /// Whether unseen faces are kept.
  bool keep_unseen = false;
  /// Reference photographs. If empty, the loss is estimated from the scene's own images.
  std::vector<Photograph> photographs = {};
  /// Cameras of other photographs in the same dataset. Those that show the scene are added to its
  /// recorded cameras. This happens only if the scene has fewer than min_representative_cameras (8)
  /// recorded cameras, and at least 8 of the training cameras show it.
  std::vector<Camera> training_cameras = {};
  gl::ContextRequest context = {};
  /// Called with the fraction done, 0..1; may throw to cancel the search.
  std::function<void(double)> progress = {};
};

struct CompressResult {
  /// The scene's soup with only the kept faces.
  TriangleSoup kept;
  CompressedSoup soup;     // the compressed form of `kept`
  std::size_t unseen = 0;  // number of removed faces
  /// Number of views tested to find the unseen faces; 0 if no face may be removed.
  std::size_t seeing_views = 0;
  /// Number of texels of the kept faces that no pixel of the `weighing_views` shows. They are
  /// stored with a larger error.
  std::size_t unseen_texels = 0;
  std::size_t weighing_views = 0;  // number of views that determine the weights of texels
  std::size_t lent_cameras = 0;    // training cameras added to the recorded ones
  CompressLoss loss;
  CompressLoss geometry_loss;  // the part from positions alone
  int position_bits = 0;
  double color_step = 0;  // compressed_basis
  double model_db = 0;    // of the uncompressed scene: CompressJudge::model_db
  CompressViews views;    // the views of the measurement
};

/// The search. If the scene has at least min_representative_cameras recorded and added cameras,
/// unseen faces are removed, unless keep_unseen is set. A face is unseen if no pixel shows it in
/// these cameras (at most 200) and in 64 views from the upper half of a sphere around the scene.
/// With fewer cameras the typical viewpoints are unknown, and all faces stay.
///
/// Positions may use 8 % of max_loss_db. They get the fewest bits whose loss stays within this
/// limit, or the largest number of bits if all exceed it. Each face is reduced to the lowest
/// lattice level whose error is below half an 8-bit step. Bisection and a scan then find the
/// largest colour step within the bound. If the coarse alpha step exceeds the bound even at the
/// finest colour step, a finer alpha step is tried.
///
/// Texels that the recorded views rarely show get a larger error, if there are at least
/// min_representative_cameras. So do texels whose features hardly change the colour
/// (CompressImportance).
///
/// Throws UsageError if the scene has no lattice texture or no result is within the bound; throws
/// the errors of CompressJudge.
CompressResult compress(const Scene& scene, const CompressRequest& request);

}  // namespace tureen
