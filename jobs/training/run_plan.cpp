#include "jobs/training/run_plan.hpp"

#include <fmt/format.h>

#include "base/decimal_text.hpp"
#include "base/memory_budget.hpp"

namespace tureen {

namespace {

Json to_json(const std::vector<OwnFact>& facts) {
  Json list = Json::array();
  for (const OwnFact& fact : facts) {
    Json& json = list.emplace_back(Json{{"code", fact.name}});
    std::visit([&](const auto& value) { json["value"] = value; }, fact.value);
    json["text"] = fact.text;
  }
  return list;
}

/// The constants that the dataset changes.
Json settled_json(const RunPlan& plan) {
  Json changed = Json::object();
  if (plan.settled.empty()) return changed;
  const Json given = Json::parse(plan.constants), settled = Json::parse(plan.settled);
  for (const auto& [key, value] : settled.items())
    if (value != given.at(key)) changed[key] = value;
  return changed;
}

std::string steps_text(const RunPlan& plan) {
  if (plan.minutes > 0) return fmt::format("as many steps as {} min allow", plan.minutes);
  return counted(std::uint64_t(plan.steps), "step");
}

std::string primitives_text(const RunPlan& plan) {
  const std::string last = counted(plan.last, noun_of(plan.kind));
  if (plan.first == plan.last) return last;
  return counted(plan.first) +
         (plan.kind == trainer::PrimitiveKind::splats ? " to at most " : " to ") + last;
}

}  // namespace

RunPlan plan_for(const Dataset& dataset) {
  const Camera& first = dataset.train.front().camera;
  std::uint64_t file_bytes = 0;
  for (const auto* views : {&dataset.train, &dataset.test})
    for (const Photograph& view : *views) file_bytes += view.file() ? view.bytes() : 0;
  return {.train_views = dataset.train.size(),
          .test_views = dataset.test.size(),
          .width = first.width,
          .height = first.height,
          .file_bytes = file_bytes};
}

std::vector<std::string> describe(const RunPlan& plan) {
  std::vector<std::string> lines;
  for (const OwnFact& note : plan.notes) lines.push_back(note.text);
  std::string line =
      fmt::format("{} and {}, the first {} x {}; {}, {}",
                  counted(plan.train_views, "training view"), counted(plan.test_views, "test view"),
                  plan.width, plan.height, steps_text(plan), primitives_text(plan));
  for (const OwnFact& detail : plan.details) line += ", " + detail.text;
  line += "; " + plan.device;
  if (plan.bytes > 0) line += ", about " + memory_size_text(plan.bytes) + " of memory";
  if (plan.file_bytes > 0)
    line += ", " + memory_size_text(plan.file_bytes) + " of photographs in a temporary file";
  lines.push_back(std::move(line));
  return lines;
}

Json to_json(const RunPlan& plan) {
  return {{"method", plan.method},
          {"input", plan.input.empty() ? Json() : Json::parse(plan.input)},
          {"train_views", plan.train_views},
          {"test_views", plan.test_views},
          {"width", plan.width},
          {"height", plan.height},
          {"steps", plan.minutes > 0 ? Json() : Json(plan.steps)},
          {"minutes", plan.minutes},
          {"primitives", name_of(plan.kind)},
          {"first", plan.first},
          {"last", plan.last},
          {"device", plan.device},
          {"bytes", plan.bytes},
          {"file_bytes", plan.file_bytes},
          {"details", to_json(plan.details)},
          {"notes", to_json(plan.notes)},
          {"text", describe(plan)},
          {"constants", Json::parse(plan.constants)},
          {"settled", settled_json(plan)}};
}

}  // namespace tureen
