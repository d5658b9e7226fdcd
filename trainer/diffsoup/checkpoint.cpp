#include "trainer/diffsoup/checkpoint.hpp"

#include <fmt/format.h>

#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <utility>

#include "scene/lattice.hpp"
#include "trainer/common/checkpoint_file.hpp"
#include "trainer/diffsoup/config_fields.hpp"
#include "trainer/diffsoup/config_file.hpp"
#include "trainer/diffsoup/levels.hpp"

namespace tureen::trainer {

namespace {

constexpr CheckpointKind kind{diffsoup_magic, checkpoint_version};

/// Visits every member of a state, in the order of the file. A new member of the structs causes a
/// compile error until it is added here.
template <class Archive, class State>
void visit_state(Archive& archive, State& state) {
  auto& [model, moments, step, errors, baseline, non_finite] = state;
  archive(step, "the step");
  archive(errors, "the errors of the faces");
  archive(baseline, "the baseline");
  archive(non_finite, "the count of quarantined numbers");
  auto& [min_level, max_level, positions, logits, mlp, origin] = model;
  archive(min_level, "the lowest level");
  archive(max_level, "the highest level");
  archive(positions, "the positions");
  archive(logits, "the texels");
  archive(mlp, "the color MLP");
  archive(origin, "the origin");
  auto& [first, second, vertex_first, vertex_second, steps, mlp_first, mlp_second, mlp_steps] =
      moments;
  archive(first, "the first moments of the texels");
  archive(second, "the second moments of the texels");
  archive(vertex_first, "the first moments of the positions");
  archive(vertex_second, "the second moments of the positions");
  archive(steps, "the steps of the faces");
  archive(mlp_first, "the first moments of the color MLP");
  archive(mlp_second, "the second moments of the color MLP");
  archive(mlp_steps, "the steps of the color MLP");
}

template <class Values>
bool all_finite(const Values& values) {
  for (const float value : values)
    if (!std::isfinite(value)) return false;
  return true;
}

std::optional<std::string> defect(const Model& model) {
  if (model.min_level < 0 || model.max_level > lattice::max_level ||
      model.min_level > model.max_level)
    return fmt::format("levels {} to {} are invalid", model.min_level, model.max_level);
  if (model.positions.size() % 3 != 0)
    return fmt::format("{} positions are not a multiple of three", model.positions.size());
  if (model.logits.size() != model.faces() * model.texels() * channels)
    return fmt::format("{} faces cannot have {} texel values", model.faces(), model.logits.size());
  bool finite = all_finite(model.logits) && all_finite(model.mlp);
  for (const glm::vec3& position : model.positions)
    finite = finite && all_finite(std::span(glm::value_ptr(position), 3));
  for (int axis = 0; axis < 3; ++axis) finite = finite && std::isfinite(model.origin[axis]);
  if (!finite) return "the model has numbers that are not finite";
  return std::nullopt;
}

std::optional<std::string> defect(const Moments& moments, const Model& model) {
  if (moments.first.size() != model.logits.size() || moments.second.size() != model.logits.size() ||
      moments.vertex_first.size() != model.positions.size() ||
      moments.vertex_second.size() != model.positions.size() ||
      moments.steps.size() != model.faces())
    return "the moments do not match the model's size";
  return std::nullopt;
}

/// The first error in the checkpoint's state; nothing if it fits its configuration and views.
std::optional<std::string> defect(const Checkpoint& checkpoint) {
  const TrainingState& state = checkpoint.state;
  if (auto reason = defect(checkpoint.views)) return reason;
  std::uint64_t pixels = 0;
  for (const ViewFingerprint& view : checkpoint.views)
    pixels += std::uint64_t(view.width) * std::uint64_t(view.height);
  if (!std::isfinite(checkpoint.seconds) || checkpoint.seconds < 0)
    return "the training time is not a number of seconds";
  if (state.step < 0 || state.step > checkpoint.config.steps)
    return fmt::format("step {} is not from 0 to {}", state.step, checkpoint.config.steps);
  if (!state.baseline.empty() && state.baseline.size() != pixels)
    return fmt::format("the baseline has {} pixels, but the views have {}", state.baseline.size(),
                       pixels);
  if (auto reason = defect(state.model)) return reason;
  if (!state.errors.empty() && state.errors.size() != state.model.faces())
    return fmt::format("{} faces have errors, but the model has {} faces", state.errors.size(),
                       state.model.faces());
  return defect(state.moments, state.model);
}

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  CheckpointWriter writer(path);
  write_head(writer, kind,
             {config_to_json(checkpoint.config), checkpoint.views, checkpoint.seconds});
  visit_state(writer, checkpoint.state);
  writer.finish();
}

Checkpoint read_checkpoint(Input input) {
  CheckpointReader reader(input);
  CheckpointHead head = read_head(reader, kind);
  Checkpoint checkpoint;
  visit_state(reader, checkpoint.state);
  reader.finish();
  checkpoint.config = config_from<Config>(
      head, input, [](Input text) { return read_config(std::move(text)); }, config_to_json);
  checkpoint.views = std::move(head.views);
  checkpoint.seconds = head.seconds;
  if (const auto reason = defect(checkpoint)) input.fail_at(0, *reason);
  return checkpoint;
}

std::optional<std::string> difference(const Config& now, const Config& checkpoint) {
  Config fitted = now;
  if (checkpoint.minutes > 0) fitted.steps = checkpoint.steps;
  return first_difference(fitted, checkpoint, config_fields());
}

}  // namespace tureen::trainer
