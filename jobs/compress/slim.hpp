// How coarse a slim file may be: the search for the smallest one whose loss stays within a bound
// (`tureen convert --compress`). formats/tureen_glb/tureen_glb_slim.hpp writes it; docs/slim.md
// describes how it works and what it reaches.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "formats/tureen_glb/tureen_glb_slim.hpp"
#include "jobs/compress/slim_judge.hpp"

namespace tureen {

struct SlimRequest {
  /// In decibels, above 0.
  double max_loss_db = 0.1;
  /// Faces that no view sees stay, too.
  bool keep_unseen = false;
  /// Empty: the loss is estimated from the scene's own pictures.
  std::vector<Photograph> photographs = {};
  /// From where other photographs of the same dataset were taken. Where telling_cameras of them at
  /// least show any of the scene, which has fewer, those join its recorded ones.
  std::vector<Camera> training_cameras = {};
  gl::ContextRequest context = {};
  /// Called now and then with the fraction done, 0..1; may throw to end the search.
  std::function<void(double)> progress = {};
};

struct SlimResult {
  /// The faces that are kept; other than that the scene's soup.
  TriangleSoup kept;
  SlimSoup soup;                 // of them
  std::size_t unseen = 0;        // faces that are left out
  std::size_t seeing_views = 0;  // that see none of those, where any may be left out
  /// Texels of the kept faces of which none of `weighing_views` shows anything: kept, but only
  /// roughly.
  std::size_t unseen_texels = 0;
  std::size_t weighing_views = 0;
  std::size_t lent_cameras = 0;  // training cameras that joined the recorded ones
  SlimLoss loss;
  SlimLoss geometry_loss;  // the part of positions alone
  int position_bits = 0;
  double color_step = 0;  // slim_basis
  double model_db = 0;    // of the scene itself: SlimJudge::model_db
  SlimViews views;        // that it was measured on
};

/// Where the scene has telling_cameras, training cameras that join them counted in, faces that
/// neither they (200 at most) nor views from the upper half of a sphere around it (64) show in any
/// pixel are left out; of fewer nobody knows where the scene is looked at from, and all faces stay.
/// Positions may take a twelfth of the loss: they get the fewest bits that keep within it. Faces
/// that a lower level says to half a step of 8 bits get that level. Then the largest step of colour
/// that keeps all of it within the bound is found by bisection and a scan, with finer alphas where
/// the coarse ones alone lose more. Texels of which the recorded views show little, where there are
/// telling_cameras, or whose features hardly move the colour, may be off further than others
/// (SlimImportance).
///
/// Throws UsageError where the scene has no lattice texture or nothing keeps within the bound, and
/// what SlimJudge throws.
SlimResult slim(const Scene& scene, const SlimRequest& request);

}  // namespace tureen
