#include "cli/provenance.hpp"

#include "cli/json_reading.hpp"

namespace tureen::cli {

Json to_json(const BenchProgram& program) {
  return {
      {"version", program.version}, {"commit", program.commit}, {"arguments", program.arguments}};
}

Json to_json(const BenchScene& scene) {
  return {{"name", scene.name},
          {"path", scene.path},
          {"triangles", scene.triangles},
          {"appearance", scene.appearance}};
}

Json to_json(const Machine& machine) {
  return {{"cpu", machine.cpu}, {"cores", machine.cores}, {"memory_mib", machine.memory_mib}};
}

Json to_json(const BenchDevice& device) {
  return {{"context", device.context},
          {"renderer", device.renderer},
          {"vendor", device.vendor},
          {"version", device.version},
          {"software", device.software}};
}

BenchProgram program_of(const JsonView& view) {
  return {.version = view["version"].text(),
          .commit = view["commit"].text(),
          .arguments = texts(view["arguments"])};
}

BenchScene scene_of(const JsonView& view) {
  return {.name = view["name"].text(),
          .path = view["path"].text(),
          .triangles = view["triangles"].natural(),
          .appearance = view["appearance"].text()};
}

Machine machine_of(const JsonView& view) {
  return {.cpu = view["cpu"].text(),
          .cores = integer(view["cores"]),
          .memory_mib = number_in(view["memory_mib"], 0, 1e12)};
}

BenchDevice device_of(const JsonView& view) {
  return {.context = view["context"].text(),
          .renderer = view["renderer"].text(),
          .vendor = view["vendor"].text(),
          .version = view["version"].text(),
          .software = boolean(view["software"])};
}

}  // namespace tureen::cli
