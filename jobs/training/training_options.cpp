#include "jobs/training/training_options.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/json/json_file.hpp"
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

std::vector<std::string> constant_names(TrainingMethodName method) {
  std::vector<std::string> names;
  const auto add = [&](const auto& fields) {
    for (const auto& field : fields) names.emplace_back(field.name);
  };
  switch (method) {
    case TrainingMethodName::diffsoup:
      add(trainer::config_fields());
      break;
    case TrainingMethodName::gaussians:
      add(trainer::splat_config_fields<GaussianConfig>());
      break;
    case TrainingMethodName::triangles:
      add(trainer::splat_config_fields<WindowConfig>());
      break;
  }
  return names;
}

/// The other method that has all constants of the file; nothing if the own method has them all, or
/// no method does.
std::optional<TrainingMethodName> other_method_of(const std::filesystem::path& file,
                                                  TrainingMethodName own) {
  Input input = Input::open(file);
  const nlohmann::json document = read_json(input);
  if (!document.is_object()) return std::nullopt;
  const auto has_all = [&](TrainingMethodName method) {
    const std::vector<std::string> names = constant_names(method);
    return std::ranges::all_of(document.items(), [&](const auto& item) {
      return std::ranges::find(names, item.key()) != names.end();
    });
  };
  if (has_all(own)) return std::nullopt;
  for (std::size_t i = 0; i < std::size(training_method_words); ++i)
    if (const auto method = TrainingMethodName(i); method != own && has_all(method)) return method;
  return std::nullopt;
}

/// The constants that `read` takes from the file of the options. Throws its InputError, or that the
/// file has the constants of another method.
template <class Read>
auto constants_of_file(const TrainingOptions& options, const Read& read) {
  const std::filesystem::path file = options.file;
  try {
    return read(file);
  } catch (const InputError&) {
    std::optional<TrainingMethodName> other;
    try {
      other = other_method_of(file, options.method);
    } catch (const InputError&) {  // the first error is about the same file
    }
    if (!other) throw;
    const std::string name = name_of(*other), own = name_of(options.method);
    throw InputError(
        {options.file, {}, {}}, "these are constants of --method " + name,
        "use --method " + name + ", or list the constants with --method " + own + " --list-config");
  }
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
C splat_base_config(const TrainingOptions& options, const C& defaults) {
  if (options.file.empty()) return defaults;
  return constants_of_file(options, [&](const std::filesystem::path& file) {
    return trainer::read_splat_config(file, defaults);
  });
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
  if (options.minutes) {
    // In a file, 0 means a fixed number of steps; on the command line, --steps does.
    if (!(*options.minutes > 0))
      throw UsageError("--minutes: " + trainer::double_text(*options.minutes) +
                           " is out of range; the time must be more than 0",
                       "--steps sets a fixed number of steps");
    config.minutes = *options.minutes;
  }
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
  const Config config = constants_of_file(options, [&](const std::filesystem::path& file) {
    return trainer::read_config(file, {.preset = kind, .published = options.published});
  });
  if (options.preset && config.preset != kind)
    throw UsageError("--preset and " + options.file + " name different presets");
  return config;
}

GaussianConfig base_config(const TrainingOptions& options, const GaussianConfig& defaults) {
  return splat_base_config(options, defaults);
}

WindowConfig base_config(const TrainingOptions& options, const WindowConfig& defaults) {
  return splat_base_config(options, defaults);
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
    if (config.max_level != trainer::automatic_level) {
      config.min_level = std::min(config.min_level, config.max_level);
      config.coarse_level = std::min(config.coarse_level, config.min_level);
    }
  }
  set_initialisation(config.initialisation, options);
  if (const std::optional<std::string> reason = trainer::defect(config)) throw UsageError(*reason);
  return config;
}

GaussianConfig with_options(const GaussianConfig& base, const TrainingOptions& options) {
  GaussianConfig config = base;
  config.flat = options.flat || base.flat;
  return splats_with_options(config, options);
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
