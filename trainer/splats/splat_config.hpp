// The constants of training that all kernels of splats share, and the functions for the
// configuration of each kernel. Files have the form of those of soups
// (trainer/diffsoup/config_file.hpp).
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "base/input.hpp"
#include "base/json/json_file.hpp"
#include "trainer/common/config_table.hpp"
#include "trainer/common/initialisation.hpp"

namespace tureen::trainer {

/// The base of GaussianConfig and WindowConfig. Defaults are those of Gaussians.
struct SplatConfig {
  int steps = 5000;
  std::uint64_t max_splats = 60000;
  /// Random ones, or samples on triangles. Points are all used, and random ones fill up to this.
  std::uint64_t first_splats = 10000;
  float first_opacity = 0.3f;
  /// Fraction of the random splats outside of the region of interest, and their largest distance
  /// from its centre, in half sides; photographs with alpha show nothing there.
  double far_splats = 0, far_extent = 8;
  int degree = 2;  // of the harmonics, up to max_trained_degree
  /// Steps of each degree of harmonics before the next one is trained, a fraction of all steps.
  double degree_steps = 0.1;
  /// Steps; in shorter runs 1/25 of all steps, but at least 20.
  int densify_every = 200;
  double densify_until = 0.8;  // fraction of the steps
  double growth = 0.3;         // largest, a fraction of the number, at each densification
  /// Images have half their width and height until this fraction of the steps.
  double half_size_until = 0.3;
  float background[3] = {1, 1, 1};
  /// Weights of L1 and of (1 - SSIM) / 2: 0.8 L1 + 0.2 (1 - SSIM) as in 3DGS.
  float l1_weight = 0.8f, ssim_weight = 0.4f;
  std::uint64_t seed = 0;
  Initialisation initialisation = Initialisation::automatic;
  /// Training time to which the run fits `steps`, in minutes; 0: `steps` as given.
  double minutes = 0;
};

/// Steps between densifications. Short runs densify more often, or they would end with few splats.
inline int densify_interval(const SplatConfig& config) {
  return std::min(config.densify_every, std::max(config.steps / 25, 20));
}

/// Whether the run densifies after this number of steps. Not after the last one, when no step would
/// train the new splats.
inline bool densifies_after(const SplatConfig& config, int step) {
  return step % densify_interval(config) == 0 && step < config.steps &&
         step <= config.densify_until * config.steps;
}

/// All fields of the configuration C, in the order of its members. C is a SplatConfig with a type
/// C::Field; each kernel specialises this function, and has an own_defect(C).
template <class C>
std::span<const typename C::Field> splat_config_fields();

/// The first error of the constants that all kernels share, beyond ranges.
std::optional<std::string> common_defect(const SplatConfig& config);

/// The first error of the configuration; nothing if it is valid.
template <class C>
std::optional<std::string> splat_config_defect(const C& config) {
  if (auto found = range_defect(config, splat_config_fields<C>())) return found;
  if (auto found = own_defect(config)) return found;
  return common_defect(config);
}

/// One flat JSON object. `defaults`: the values of fields that it does not name. Throws InputError
/// with the file and the field.
template <class C>
C read_splat_config(Input input, const C& defaults = {}) {
  const nlohmann::json document = read_json(input, RepeatedKeys::refused);
  const JsonView root(document, input.name());
  C config = defaults;
  assign_fields(config, splat_config_fields<C>(), root);
  if (const std::optional<std::string> reason = splat_config_defect(config)) root.fail(*reason);
  return config;
}

/// All fields, one per line; read_splat_config() returns the same bits from it.
template <class C>
std::string splat_config_to_json(const C& config) {
  return fields_to_json(config, splat_config_fields<C>());
}

/// The first field that differs between a resumed run and its checkpoint; nothing if all are equal.
/// With minutes, the steps may differ: the checkpoint has fitted ones.
template <class C>
std::optional<std::string> splat_config_difference(const C& now, const C& checkpoint) {
  C fitted = now;
  if (checkpoint.minutes > 0) fitted.steps = checkpoint.steps;
  return first_difference(fitted, checkpoint, splat_config_fields<C>());
}

/// All constants as text: name, default, meaning, range or words.
template <class C>
std::string splat_config_reference() {
  const C config;
  std::string text;
  for (const auto& field : splat_config_fields<C>())
    text += field_reference(config, field, value_text(config, field));
  return text;
}

}  // namespace tureen::trainer
