// What `tureen tradeoff` found, for people and for programs: tables and a JSON document
// (docs/json.md). E_render and E_model stand in columns and tables of
// their own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "jobs/results/bench_json.hpp"
#include "jobs/results/json_text.hpp"
#include "jobs/tradeoff/model_errors.hpp"
#include "jobs/tradeoff/panel.hpp"

namespace tureen::results {

/// What the document calls itself, and the version of its layout.
inline constexpr const char* tradeoff_format = "tureen tradeoff";
inline constexpr int tradeoff_version = 1;

/// What E_model was measured with.
struct ModelProtocol {
  std::string dataset;  // as typed
  std::string split;    // "test"
  int photographs = 0;
  std::string ssim_border;
};

struct TradeoffReport {
  std::string date;  // "2026-11-21T15:04:05Z"
  BenchProgram program;
  BenchScene scene;
  Machine machine;
  BenchDevice device;
  std::string camera_set;  // "hemisphere:4"
  int width = 0, height = 0, views = 0, rounds = 0;
  bool with_flip = true;
  std::string clock;            // what times are read from, in words
  bool processor_time = false;  // of all threads, instead of time that passed
  std::string samples;          // of the drawing panel's reference: "device" or "exact"
  tradeoff::Limits limits;
  tradeoff::Study study;
  /// Of the drawing panel's outcomes and of the antialiasing one's, in their order; nothing for
  /// those that were not measured. Empty without a dataset.
  std::vector<std::optional<tradeoff::ModelError>> drawing_model, antialiasing_model;
  std::optional<ModelProtocol> model;
  std::optional<std::string> scene_written;  // by --write, where
  std::vector<std::string> notes;            // on reading the scene, the cameras, the dataset
  std::vector<std::string> output;           // files that were written
};

Json to_json(const TradeoffReport& report);

}  // namespace tureen::results
