#include "jobs/bench/provenance.hpp"

#include "jobs/bench/json_reading.hpp"

namespace tureen::results {

Json to_json(const BenchProgram& program) {
  Json json{
      {"version", program.version}, {"commit", program.commit}, {"arguments", program.arguments}};
  if (!program.build.empty()) json["build"] = program.build;
  return json;
}

Json to_json(const BenchScene& scene) {
  return {{"name", scene.name},
          {"path", scene.path},
          {"triangles", scene.triangles},
          {"splats", scene.splats},
          {"appearance", scene.appearance}};
}

Json to_json(const Machine& machine) {
  Json json{{"cpu", machine.cpu}, {"cores", machine.cores}, {"memory_mib", machine.memory_mib}};
  if (machine.rasteriser_threads) json["rasteriser_threads"] = *machine.rasteriser_threads;
  return json;
}

Json to_json(const BenchDevice& device) {
  return {{"context", device.context},
          {"renderer", device.renderer},
          {"vendor", device.vendor},
          {"version", device.version},
          {"software", device.software}};
}

/// Longest text in bytes: the usual limit for paths; names are shorter.
constexpr std::size_t longest_text = 4096;

BenchProgram program_of(const JsonView& view) {
  const std::optional<JsonView> build = view.find("build");
  return {.version = text_within(view["version"], longest_text),
          .commit = text_within(view["commit"], longest_text),
          .arguments = texts(view["arguments"]),
          .build = build ? text_within(*build, longest_text) : std::string()};
}

BenchScene scene_of(const JsonView& view) {
  const std::optional<JsonView> splats = view.find("splats");
  return {.name = text_within(view["name"], longest_text),
          .path = text_within(view["path"], longest_text),
          .triangles = view["triangles"].natural(),
          .appearance = text_within(view["appearance"], longest_text),
          .splats = splats ? splats->natural() : 0};
}

Machine machine_of(const JsonView& view) {
  Machine machine{.cpu = text_within(view["cpu"], longest_text),
                  .cores = integer(view["cores"]),
                  .memory_mib = number_in(view["memory_mib"], 0, 1e12)};
  if (const auto threads = view.find("rasteriser_threads"))
    machine.rasteriser_threads = integer(*threads);
  return machine;
}

BenchDevice device_of(const JsonView& view) {
  return {.context = text_within(view["context"], longest_text),
          .renderer = text_within(view["renderer"], longest_text),
          .vendor = text_within(view["vendor"], longest_text),
          .version = text_within(view["version"], longest_text),
          .software = view["software"].boolean()};
}

}  // namespace tureen::results
