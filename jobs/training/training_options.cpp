#include "jobs/training/training_options.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "trainer/diffsoup/config_fields.hpp"
#include "trainer/diffsoup/config_file.hpp"

namespace tureen {

using trainer::Config;
using trainer::GaussianConfig;
using trainer::Initialisation;
using trainer::Preset;
using trainer::WindowConfig;

namespace {

/// The error for a value beyond the type of the constant `name`, which is beyond its range, too.
template <class Fields>
[[noreturn]] void refuse(std::int64_t value, std::string_view name, Fields fields) {
  const auto field = std::find_if(fields.begin(), fields.end(),
                                  [&](const auto& candidate) { return candidate.name == name; });
  throw UsageError(std::string(name) + ": " +
                   field->range.refusal(double(value), std::to_string(value)));
}

template <class Fields>
int as_int(std::int64_t value, std::string_view name, Fields fields) {
  if (!std::in_range<int>(value)) refuse(value, name, fields);
  return static_cast<int>(value);
}

void set_initialisation(Initialisation& initialisation, const TrainingOptions& options) {
  if (options.begin == "random")
    initialisation = Initialisation::random;
  else if (options.begin == "points")
    initialisation = Initialisation::points;
  else if (!options.begin.empty())
    initialisation = Initialisation::mesh;
}

template <class C>
C splats_with_options(C config, const TrainingOptions& options) {
  const auto fields = trainer::splat_config_fields<C>();
  if (options.steps) {
    config.steps = as_int(*options.steps, "steps", fields);
    config.minutes = 0;
  }
  if (options.max_splats) {
    if (*options.max_splats < 0) refuse(*options.max_splats, "max_splats", fields);
    config.max_splats = std::uint64_t(*options.max_splats);
  }
  config.minutes = options.minutes.value_or(config.minutes);
  config.seed = options.seed.value_or(config.seed);
  set_initialisation(config.initialisation, options);
  if (const std::optional<std::string> reason = trainer::splat_config_defect(config))
    throw UsageError(*reason);
  return config;
}

}  // namespace

Config base_config(const TrainingOptions& options, Preset otherwise) {
  const Preset kind = options.preset.value_or(otherwise);
  if (options.file.empty())
    return options.published ? trainer::published(kind) : trainer::preset(kind);
  const Config config = trainer::read_config(std::filesystem::path(options.file),
                                             {.preset = kind, .published = options.published});
  if (options.preset && config.preset != kind)
    throw UsageError("--preset and " + options.file + " name different presets");
  return config;
}

Config with_options(const Config& base, const TrainingOptions& options) {
  const auto fields = trainer::config_fields();
  Config config = base;
  if (options.triangles) {
    const double ratio = double(*options.triangles) / config.triangles;
    config.initial_triangles =
        int(std::clamp(std::round(config.initial_triangles * ratio), 1.0, 4e6));
    config.triangles = as_int(*options.triangles, "triangles", fields);
  }
  if (options.steps) config.steps = as_int(*options.steps, "steps", fields);
  if (options.batch) config.batch = as_int(*options.batch, "batch", fields);
  config.seed = options.seed.value_or(config.seed);
  if (options.level) {
    config.max_level = as_int(*options.level, "max_level", fields);
    config.min_level = std::min(config.min_level, config.max_level);
    config.coarse_level = std::min(config.coarse_level, config.min_level);
  }
  set_initialisation(config.initialisation, options);
  if (const std::optional<std::string> reason = trainer::defect(config)) throw UsageError(*reason);
  return config;
}

GaussianConfig with_options(const GaussianConfig& base, const TrainingOptions& options) {
  return splats_with_options(base, options);
}

WindowConfig with_options(const WindowConfig& base, const TrainingOptions& options) {
  WindowConfig config = base;
  config.opaque = options.opaque || base.opaque;
  return splats_with_options(config, options);
}

std::string constants_reference(const TrainingOptions& options) {
  switch (options.method) {
    case TrainingMethodName::gaussians:
      return trainer::splat_config_reference<GaussianConfig>();
    case TrainingMethodName::triangles:
      return trainer::splat_config_reference<WindowConfig>();
    case TrainingMethodName::diffsoup:
      break;
  }
  return trainer::config_reference();
}

}  // namespace tureen
