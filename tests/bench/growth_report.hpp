// What growth_benchmark found: fitted, in words, as JSON, plots and a page.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bench/cost_fit.hpp"
#include "runtime/frame_statistics.hpp"

namespace tureen::test {

struct GrowthPoint {
  std::string kind;    // "opaque", "cut-out"
  std::string series;  // what grows: "triangles", "pixels", "overdraw", or "shape": edges alone
  int layers = 0;
  int width = 0, height = 0;
  CostSample sample = {};  // its time is the smallest of the rounds' medians
  double p95_ms = 0;
  double aa_spread = 0;               // of every second round against those between them
  double spread = 0;                  // of the rounds' medians, as FrameStatistics has it
  std::vector<double> round_ms = {};  // the rounds' medians, in the order in which they were made
  int unsettled_rounds = 0;           // whose warm-up did not come to rest
  double elongation = 1;              // a cell's width over its height
  bool anchor = false;                // the frame that every series has, timed anew in each
};

struct Growth {
  std::string commit, cpu, context, renderer;
  bool software = false;
  bool processor_time = false;  // times are that, of all threads
  std::vector<GrowthPoint> points = {};
  std::map<std::string, CostFit> fits = {};  // by kind; without those that could not be fitted
};

/// A model that misses a measurement by more than this, and by more than twice the noise, misses
/// something that matters and is to be looked into.
inline constexpr double suspicious_residual = 0.2;

/// The point's time and spreads. Asserts least_rounds; of an odd number the last one has no
/// other to be compared with.
void take_times(GrowthPoint& point, const FrameTimes& times);

/// How far apart the times of the kind's anchors lie, relative to the smallest; 0 of fewer than
/// two.
double anchor_spread(const Growth& growth, const std::string& kind);

/// The difference that means nothing: the largest of a point's spreads and of its kind's anchors'.
double noise(const Growth& growth, const GrowthPoint& point);

/// To all points but those of the series "shape", which the model cannot tell apart.
void fit(Growth& growth);

std::string point_line(const GrowthPoint& point);

/// Sentences, each of one kind: the cost of each thing with its standard error (it alone has the
/// words "a frame costs"), what dominates at 1280x720, which is where anchors are, which points the
/// model misses, whether edges cost, and how far the anchors lie apart.
std::vector<std::string> explanation(const Growth& growth);

/// growth.json, growth.html and, where gnuplot is installed, growth-SERIES.svg and growth-fit.svg.
void write_growth(const Growth& growth, const std::filesystem::path& folder);

}  // namespace tureen::test
