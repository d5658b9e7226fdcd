// Holds a backend against the processor's on random soups: whoever does a step, it is the same
// step.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "trainer/diffsoup/backend.hpp"

namespace tureen::trainer::test {

using MakeBackend =
    std::function<std::unique_ptr<Backend>(std::span<const TrainingView>, const Config&)>;

/// What is drawn, and which pixels each face wins.
void expect_same_images(const MakeBackend& make);
/// Parameters and moments after a step, and its report.
void expect_same_step(const MakeBackend& make);
/// The same of small images, ignored pixels, baseline or none, dense updates, one level.
void expect_same_step_in_odd_cases(const MakeBackend& make);
/// upload() and download() change nothing.
void expect_state_kept(const MakeBackend& make);
/// Two runs, bit by bit; also one that was interrupted.
void expect_same_bits_again(const MakeBackend& first, const MakeBackend& second);
/// A training that goes on from a checkpoint's file against one that never stopped, bit by bit.
void expect_same_end_after_a_break(const MakeBackend& make);
/// What cannot be learned from is left out and counted.
void expect_quarantine(const MakeBackend& make);
/// PSNR after `steps`, on both.
void expect_same_training(const MakeBackend& make, int steps);

}  // namespace tureen::trainer::test
