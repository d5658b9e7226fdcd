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

/// The configuration that ratios are taken of: "published" where it was measured, else the first.
std::string reference_configuration(const BenchResult& result);

/// How many times as fast as the reference in the same place; 0 where that was not measured.
double times_as_fast(const BenchResult& result, const BenchMeasurement& measurement);

}  // namespace tureen::cli
