// The result of `tureen tradeoff` and its JSON document (docs/json.md). E_render and E_model are
// separate members.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/json/json_text.hpp"
#include "jobs/bench/bench_json.hpp"
#include "jobs/tradeoff/panel.hpp"

namespace tureen::results {

/// The member "format" of the document, and the version of its layout.
inline constexpr const char* tradeoff_format = "tureen tradeoff";
inline constexpr int tradeoff_version = 1;

/// The photographs and metric settings of E_model.
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
  std::string clock;            // description of the clock
  bool processor_time = false;  // of all threads, instead of elapsed time
  std::string samples;          // reference of the drawing panel: "device" or "exact"
  tradeoff::Limits limits;
  tradeoff::Study study;
  /// E_model; empty without a dataset.
  std::optional<ModelProtocol> model;
  std::optional<std::string> scene_written;  // path from --write
  std::vector<std::string> notes;            // on reading the scene, the cameras, the dataset
  std::vector<std::string> output;           // written files
};

Json to_json(const TradeoffReport& report);

}  // namespace tureen::results
