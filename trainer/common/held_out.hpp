// The error of a run in held-out views, which it does not train on. The trainer draws them itself,
// quickly enough for every few hundred steps. The runtime draws the images for the final report
// (jobs/eval/evaluation.hpp).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "image/image.hpp"
#include "scene/photographs.hpp"
#include "trainer/common/trainable.hpp"

namespace tureen::trainer {

/// The mean PSNR over the views, against the photograph over the background, as in evaluate().
/// `progress`: optional function, called with the completed fraction; it may throw.
double mean_psnr_db(Trainable& run, std::span<const Photograph> views,
                    const std::function<void(double)>& progress = {});

/// The view's photograph, the trainer's image, and their difference, side by side.
Image8 preview(Trainable& run, const Photograph& view);

/// At most `count` of the views, evenly spread, including the first.
std::vector<Photograph> some_of(std::span<const Photograph> views, std::size_t count);

}  // namespace tureen::trainer
