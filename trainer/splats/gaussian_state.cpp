#include "trainer/splats/gaussian_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/existing_path.hpp"
#include "trainer/common/checkpoint_file.hpp"

namespace tureen::trainer {

namespace {

constexpr CheckpointKind gaussian_kind{gaussians_magic, gaussian_checkpoint_version};

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
  std::int32_t fits = 0;
};

template <class Archive, class State>
void visit_gaussian_state(Archive& archive, State& state) {
  auto& [degree, count, drawn, raw, statistics, moments, random, step, epoch, non_finite, fits] =
      state;
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
  archive(fits, "the number of fits");
}

std::vector<float> values_of(const splatting::ParameterRows& rows) {
  return {rows.values().begin(), rows.values().end()};
}

StoredState stored(const GaussianState& state) {
  return {.degree = state.parameters.degree,
          .count = state.parameters.count(),
          .drawn = values_of(state.parameters.drawn),
          .raw = values_of(state.parameters.raw),
          .statistics = values_of(state.memory.statistics),
          .moments = state.memory.moments,
          .random = std::bit_cast<std::uint64_t>(state.random),
          .step = state.step,
          .epoch = state.epoch,
          .non_finite = state.non_finite,
          .fits = state.fits};
}

/// Whether the arrays have the sizes that the count and the degree need.
bool fits_its_count(const StoredState& state) {
  // More floats than the file has, without overflow in the products below.
  if (state.count > state.drawn.size()) return false;
  const GaussianParameters none(0, state.degree);
  const std::uint64_t lines =
      (state.count + splatting::row_alignment - 1) / splatting::row_alignment;
  const std::uint64_t stride = lines * splatting::row_alignment;
  return state.drawn.size() == none.rows() * stride &&
         state.raw.size() == GaussianParameters::raw_rows * stride &&
         state.statistics.size() == splat_statistic::count * stride &&
         state.moments.size() == 2 * none.rows() * lines;
}

std::optional<std::string> defect(const StoredState& state, const GaussianConfig& config,
                                  std::size_t views) {
  if (state.degree != config.degree)
    return fmt::format("the splats have degree {}, but the configuration has {}", state.degree,
                       config.degree);
  if (!fits_its_count(state))
    return fmt::format("the parameters do not match {} splats", state.count);
  if (state.step < 0 || state.step > config.steps)
    return fmt::format("step {} is not from 0 to {}", state.step, config.steps);
  if (state.epoch.size() > views ||
      std::any_of(state.epoch.begin(), state.epoch.end(), [&](auto i) { return i >= views; }))
    return fmt::format("the epoch does not match {} views", views);
  if (state.fits < 0) return "the number of fits is negative";
  return std::nullopt;
}

void copy_to(splatting::ParameterRows& rows, const std::vector<float>& values) {
  std::copy(values.begin(), values.end(), rows.values().begin());
}

GaussianState restored(StoredState&& stored) {
  GaussianState state{.random = std::bit_cast<Random>(stored.random),
                      .step = stored.step,
                      .epoch = std::move(stored.epoch),
                      .non_finite = stored.non_finite,
                      .fits = stored.fits};
  state.parameters = GaussianParameters(stored.count, stored.degree);
  copy_to(state.parameters.drawn, stored.drawn);
  copy_to(state.parameters.raw, stored.raw);
  state.memory = SplatMemory(state.parameters.rows(), state.parameters.count());
  copy_to(state.memory.statistics, stored.statistics);
  state.memory.moments = std::move(stored.moments);
  return state;
}

GaussianConfig parsed_gaussian_config(Input& text) { return read_gaussian_config(text); }

}  // namespace

void write_checkpoint(const std::filesystem::path& path, const GaussianCheckpoint& checkpoint) {
  CheckpointWriter writer(path);
  write_head(writer, gaussian_kind,
             {config_to_json(checkpoint.config), checkpoint.views, checkpoint.seconds});
  const StoredState state = stored(checkpoint.state);
  visit_gaussian_state(writer, state);
  writer.finish();
}

GaussianCheckpoint read_gaussian_checkpoint(Input& input) {
  CheckpointReader reader(input);
  CheckpointHead head = read_head(reader, gaussian_kind);
  StoredState state;
  visit_gaussian_state(reader, state);
  reader.finish();
  GaussianCheckpoint checkpoint;
  checkpoint.config = config_from(head, input, parsed_gaussian_config, config_to_json);
  if (!std::isfinite(head.seconds) || head.seconds < 0)
    input.fail_at(0, "the training time is not a number of seconds");
  if (const auto reason = defect(head.views)) input.fail_at(0, *reason);
  if (const auto reason = defect(state, checkpoint.config, head.views.size()))
    input.fail_at(0, *reason);
  checkpoint.views = std::move(head.views);
  checkpoint.seconds = head.seconds;
  checkpoint.state = restored(std::move(state));
  return checkpoint;
}

GaussianCheckpoint read_gaussian_checkpoint(const std::filesystem::path& path) {
  require_there(path);
  Input input = Input::open(path);
  return read_gaussian_checkpoint(input);
}

}  // namespace tureen::trainer
