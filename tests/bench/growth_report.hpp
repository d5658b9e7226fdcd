// What growth_benchmark found: fitted, in words, as JSON, plots and a page.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/cost_fit.hpp"

namespace tureen::test {

struct GrowthPoint {
  std::string kind;    // "opaque", "cut-out"
  std::string series;  // "triangles", "pixels", "overdraw": which of them grows
  int layers = 0;
  int width = 0, height = 0;
  CostSample sample = {};  // its time is the smallest of the rounds' medians
  double p95_ms = 0;
  double aa_spread = 0;
};

struct Growth {
  std::string commit, cpu, context, renderer;
  bool software = false;
  bool processor_time = false;  // times are that, of all threads
  std::vector<GrowthPoint> points = {};
  std::map<std::string, CostFit> fits = {};  // by kind; without those that could not be fitted
};

/// A model that misses a measurement by more than this misses something that matters and is to be
/// looked into.
inline constexpr double suspicious_residual = 0.2;

void fit(Growth& growth);

std::string point_line(const GrowthPoint& point);

/// Sentences: the cost of each thing with its standard error, what dominates at 1280x720, and which
/// points the model misses.
std::vector<std::string> explanation(const Growth& growth);

/// growth.json, growth.html and, where gnuplot is installed, growth-SERIES.svg and growth-fit.svg.
void write_growth(const Growth& growth, const std::filesystem::path& folder);

}  // namespace tureen::test
