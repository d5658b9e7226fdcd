// Compares a backend with the processor's on random soups: their steps must be the same.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "trainer/diffsoup/backend.hpp"

namespace tureen::trainer::test {

using MakeBackend =
    std::function<std::unique_ptr<Backend>(std::span<const TrainingView>, const Config&)>;

/// Compares rendered images, and the number of visible pixels of each face.
void expect_same_images(const MakeBackend& make);
/// Compares parameters and moments after a step, and its report.
void expect_same_step(const MakeBackend& make);
/// As expect_same_step(), for small images, ignored pixels, with and without baseline, dense
/// updates, one level.
void expect_same_step_in_odd_cases(const MakeBackend& make);
/// upload() and download() change nothing.
void expect_state_kept(const MakeBackend& make);
/// Compares two runs bit by bit; the second is interrupted and resumed.
void expect_same_bits_again(const MakeBackend& first, const MakeBackend& second);
/// Compares a training resumed from a checkpoint file with an uninterrupted one, bit by bit.
void expect_same_end_after_a_break(const MakeBackend& make);
/// Non-finite pixels and gradients are excluded and counted.
void expect_quarantine(const MakeBackend& make);
/// Compares the PSNR after `steps`.
void expect_same_training(const MakeBackend& make, int steps);

}  // namespace tureen::trainer::test
