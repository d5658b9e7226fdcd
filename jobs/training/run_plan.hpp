// What a training run will do, settled once from the options and the dataset: for people, and as
// the first line of the run's log.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "base/json/json_text.hpp"
#include "scene/photographs.hpp"
#include "trainer/common/primitive_count.hpp"

namespace tureen {

/// A fact that only some methods have.
struct OwnFact {
  std::string name;  // its key in the JSON of a result, its "code" in that of a plan
  std::variant<bool, double, std::string> value;
  std::string text = {};  // for people; empty: nothing to report
};

struct RunPlan {
  std::string method = {};  // as --method takes it
  std::uint64_t train_views = 0, test_views = 0;
  int width = 0, height = 0;  // of the first photograph
  int steps = 0;
  double minutes = 0;  // more than 0: the steps are fitted to this time, whatever `steps` is
  trainer::PrimitiveKind kind = trainer::PrimitiveKind::triangles;
  std::uint64_t first = 0;            // primitives before the first step
  std::uint64_t last = 0;             // at the end: of triangles; of splats at most
  std::string device = {};            // "CPU, 2 threads"
  std::uint64_t bytes = 0;            // of memory, an estimate; 0: unknown
  std::uint64_t file_bytes = 0;       // of photographs that memory does not hold
  std::vector<OwnFact> details = {};  // phrases: "textures of level 4"
  std::vector<OwnFact> notes = {};    // sentences: why the constants are as they are, and warnings
  std::string constants = {};         // JSON, as --config takes it
  std::string input = {};             // JSON: how the program read the photographs; may be empty
  /// The constants in the units of the dataset, with the values that `constants` leaves to it;
  /// empty: the run uses `constants` as they are.
  std::string settled = {};
};

/// A plan with the views of the dataset, which has a training view.
RunPlan plan_for(const Dataset& dataset);

/// The notes, then one line about the run.
std::vector<std::string> describe(const RunPlan& plan);

/// With describe() as "text". "steps" is null with minutes. Of `settled`, only what differs from
/// `constants`.
Json to_json(const RunPlan& plan);

}  // namespace tureen
