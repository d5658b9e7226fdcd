// A result of `tureen bench` as plots: frame time against pixels, view by view, and as ratios.
#pragma once

#include <string>
#include <vector>

#include "cli/bench_result.hpp"
#include "cli/figures.hpp"

namespace tureen::cli {

/// For each set of cameras: the median against the pixels of a frame, from the fastest round's
/// median to the 95th percentile, a line a configuration; the median of each view at the largest
/// size, where there are several views. Over all of them: how many times as fast as the reference.
/// Texts from the result reach gnuplot as texts only.
std::vector<Figure> bench_plots(const BenchResult& result);

}  // namespace tureen::cli
