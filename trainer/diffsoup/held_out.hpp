// How near a run has come to views that it does not train on, drawn by the trainer itself: quick
// enough for every few hundred steps. What is reported in the end is drawn by the runtime
// (jobs/eval/evaluation.hpp).
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "image/image.hpp"
#include "scene/photographs.hpp"
#include "trainer/diffsoup/backend.hpp"
#include "trainer/diffsoup/config.hpp"

namespace tureen::trainer {

/// The camera's image as a device would write it, 8 bits a channel, opaque.
Image8 drawn(Backend& backend, const Camera& camera);

/// The mean over views of the PSNR against the photograph over the background, as evaluate()
/// measures it. `progress`, where there is one, is called with the fraction done and may throw.
double mean_psnr_db(Backend& backend, std::span<const Photograph> views, const Config& config,
                    const std::function<void(double)>& progress = {});

/// The view's photograph, what the trainer draws, and where they differ.
Image8 preview(Backend& backend, const Photograph& view, const Config& config);

/// At most `count` of the views, evenly spread, the first among them.
std::vector<Photograph> some_of(std::span<const Photograph> views, std::size_t count);

}  // namespace tureen::trainer
