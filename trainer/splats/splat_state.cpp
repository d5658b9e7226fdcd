#include "trainer/splats/splat_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace tureen::trainer {

template <>
const CheckpointKind checkpoint_kind<GaussianCheckpoint>{gaussians_magic, 2};
template <>
const CheckpointKind checkpoint_kind<NeuralCheckpoint>{neural_magic, 2};
template <>
const CheckpointKind checkpoint_kind<WindowCheckpoint>{triangles_magic, 2};

namespace {

/// Values of a state in the form of the file.
struct StoredState {
  std::int32_t degree = 0;
  std::uint64_t count = 0;
  std::vector<float> drawn, raw, statistics;  // rows with their padding
  std::vector<SplatMemory::Line> moments;
  std::uint64_t random = 0;
  std::int32_t step = 0;
  std::vector<std::uint32_t> epoch;
  std::uint64_t non_finite = 0;
  float solidity = 0;  // WindowParameters::solidity; other kernels have 0
};

template <class Archive, class State>
void visit_splat_state(Archive& archive, State& state) {
  auto& [degree, count, drawn, raw, statistics, moments, random, step, epoch, non_finite,
         solidity] = state;
  archive(degree, "the degree");
  archive(count, "the number of splats");
  archive(drawn, "the drawn parameters");
  archive(raw, "the trained parameters");
  archive(statistics, "the statistics");
  archive(moments, "the moments");
  archive(random, "the state of the random numbers");
  archive(step, "the step");
  archive(epoch, "the views of the epoch");
  archive(non_finite, "the count of quarantined numbers");
  archive(solidity, "the solidity");
}

std::vector<float> values_of(const splatting::ParameterRows& rows) {
  return {rows.values().begin(), rows.values().end()};
}

template <class Parameters>
StoredState stored(const SplatState<Parameters>& state) {
  StoredState result{.degree = state.parameters.degree,
                     .count = state.parameters.count(),
                     .drawn = values_of(state.parameters.drawn),
                     .raw = values_of(state.parameters.raw),
                     .statistics = values_of(state.memory.statistics),
                     .moments = state.memory.moments,
                     .random = std::bit_cast<std::uint64_t>(state.random),
                     .step = state.step,
                     .epoch = state.epoch,
                     .non_finite = state.non_finite};
  if constexpr (requires { state.parameters.solidity; })
    result.solidity = state.parameters.solidity;
  return result;
}

/// Whether the arrays have the sizes that the count and the degree need.
template <class Parameters>
bool fits_its_count(const StoredState& state) {
  // More floats than the file has, without overflow in the products below.
  if (state.count > state.drawn.size()) return false;
  const std::uint64_t rows = Parameters(0, state.degree).rows();
  const std::uint64_t lines =
      (state.count + splatting::row_alignment - 1) / splatting::row_alignment;
  const std::uint64_t stride = lines * splatting::row_alignment;
  return state.drawn.size() == rows * stride && state.raw.size() == Parameters::raw_rows * stride &&
         state.statistics.size() == splat_statistic::count * stride &&
         state.moments.size() == 2 * rows * lines;
}

template <class Parameters>
std::optional<std::string> defect(const StoredState& state, const SplatConfig& config,
                                  std::size_t views) {
  if (state.degree != config.degree)
    return fmt::format("the splats have degree {}, but the configuration has {}", state.degree,
                       config.degree);
  if (!fits_its_count<Parameters>(state))
    return fmt::format("the parameters do not match {} splats", state.count);
  if (state.step < 0 || state.step > config.steps)
    return fmt::format("step {} is not from 0 to {}", state.step, config.steps);
  if (state.epoch.size() > views ||
      std::any_of(state.epoch.begin(), state.epoch.end(), [&](auto i) { return i >= views; }))
    return fmt::format("the epoch does not match {} views", views);
  if (!(state.solidity >= 0 && state.solidity < 1)) return "the solidity is not from 0 to 1";
  return std::nullopt;
}

void copy_to(splatting::ParameterRows& rows, const std::vector<float>& values) {
  std::copy(values.begin(), values.end(), rows.values().begin());
}

template <class Parameters>
SplatState<Parameters> restored(StoredState&& stored) {
  SplatState<Parameters> state{.random = std::bit_cast<Random>(stored.random),
                               .step = stored.step,
                               .epoch = std::move(stored.epoch),
                               .non_finite = stored.non_finite};
  state.parameters = Parameters(stored.count, stored.degree);
  copy_to(state.parameters.drawn, stored.drawn);
  copy_to(state.parameters.raw, stored.raw);
  if constexpr (requires { state.parameters.solidity; })
    state.parameters.solidity = stored.solidity;
  state.memory = SplatMemory(state.parameters.rows(), state.parameters.count());
  copy_to(state.memory.statistics, stored.statistics);
  state.memory.moments = std::move(stored.moments);
  return state;
}

template <class Config, class Parameters>
void read_into(SplatCheckpoint<Config, Parameters>& checkpoint, Input& input) {
  CheckpointReader reader(input);
  CheckpointHead head = read_head(reader, checkpoint_kind<SplatCheckpoint<Config, Parameters>>);
  StoredState state;
  visit_splat_state(reader, state);
  reader.finish();
  checkpoint.config = config_from<Config>(
      head, input, [](Input text) { return read_splat_config<Config>(std::move(text)); },
      splat_config_to_json<Config>);
  if (!std::isfinite(head.seconds) || head.seconds < 0)
    input.fail_at(0, "the training time is not a number of seconds");
  if (const auto reason = defect(head.views)) input.fail_at(0, *reason);
  if (const auto reason = defect<Parameters>(state, checkpoint.config, head.views.size()))
    input.fail_at(0, *reason);
  checkpoint.views = std::move(head.views);
  checkpoint.seconds = head.seconds;
  checkpoint.state = restored<Parameters>(std::move(state));
}

}  // namespace

template <class Config, class Parameters>
void write_checkpoint(const std::filesystem::path& path,
                      const SplatCheckpoint<Config, Parameters>& checkpoint) {
  CheckpointWriter writer(path);
  write_head(writer, checkpoint_kind<SplatCheckpoint<Config, Parameters>>,
             {splat_config_to_json(checkpoint.config), checkpoint.views, checkpoint.seconds});
  const StoredState state = stored(checkpoint.state);
  visit_splat_state(writer, state);
  writer.finish();
}

template <class Checkpoint>
Checkpoint read_splat_checkpoint(Input input) {
  Checkpoint checkpoint;
  read_into(checkpoint, input);
  return checkpoint;
}

template void write_checkpoint(const std::filesystem::path&, const GaussianCheckpoint&);
template GaussianCheckpoint read_splat_checkpoint(Input);
template void write_checkpoint(const std::filesystem::path&, const NeuralCheckpoint&);
template NeuralCheckpoint read_splat_checkpoint(Input);
template void write_checkpoint(const std::filesystem::path&, const WindowCheckpoint&);
template WindowCheckpoint read_splat_checkpoint(Input);

}  // namespace tureen::trainer
