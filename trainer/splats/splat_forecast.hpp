// The time and the memory of a run of splats, estimated before its start.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "scene/photographs.hpp"
#include "trainer/splats/splat_config.hpp"

namespace tureen::trainer {

// Config is GaussianConfig, NeuralConfig or WindowConfig.

/// Where a forecast assumes the photographs: where they are, or all in a file.
enum class PhotographPlace { as_now, in_file };

/// Bytes that a run needs at its largest: the program, photographs, parameters with their moments
/// (twice, while their number grows), lists of tiles, and planes of images. An estimate: lists
/// depend on the sizes of splats.
template <class Config>
std::uint64_t splat_memory(const Config& config, const Dataset& dataset,
                           PhotographPlace place = PhotographPlace::as_now);

/// The largest max_splats, at most config.max_splats, with which splat_memory() is at most
/// `bytes`; nullopt if not even 1,000 splats fit.
template <class Config>
std::optional<std::uint64_t> max_splats_within(std::uint64_t bytes, const Config& config,
                                               const Dataset& dataset,
                                               PhotographPlace place = PhotographPlace::as_now);

/// The work of a step on images with half the width and height, relative to one of full size: a
/// quarter of the pixels, but all splats. An estimate; tests/bench/splat_steps.cpp prints the times
/// with half_size_until 1 and 0.
inline constexpr double half_size_work = 0.28;

/// The work of all steps after the first `done`, in steps of full size.
double remaining_work(const SplatConfig& config, int done);

/// The mean time of the steps after the first `done`, over that of a step with `count` splats: the
/// number grows as fast as it may, and the time of a step in proportion to it. An estimate.
double growth_of_work(const SplatConfig& config, int done, std::size_t count);

/// The number of steps, of which `done` are done, whose remaining work takes `seconds` if a step of
/// full size takes `step_seconds`; at least done + 1, at most 10 million.
int fitted_steps(const SplatConfig& config, int done, double seconds, double step_seconds);

}  // namespace tureen::trainer
