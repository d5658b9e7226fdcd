// The options of a training run: a method, a preset or a file of constants, and the most common
// single constants. A file can set all constants.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "trainer/diffsoup/config.hpp"
#include "trainer/diffsoup/device.hpp"
#include "trainer/splats/gaussians/gaussian_config.hpp"
#include "trainer/splats/windows/window_config.hpp"

namespace tureen {

enum class TrainingMethodName { diffsoup, gaussians, triangles };

/// In the order of the enumerators, as --method takes them.
inline constexpr const char* training_method_words[] = {"diffsoup", "gaussians", "triangles"};

constexpr const char* name_of(TrainingMethodName method) {
  return training_method_words[std::size_t(method)];
}

struct TrainingOptions {
  TrainingMethodName method = TrainingMethodName::diffsoup;
  std::string file;                   // of constants; empty: none
  std::optional<std::int64_t> steps;  // with_options() checks ranges, here and below
  std::optional<std::uint64_t> seed;
  std::string begin;  // "random", "points", a scene, or empty

  // Only of diffsoup.
  std::optional<trainer::Preset> preset;
  bool published = false;
  std::optional<std::int64_t> triangles, batch, level;
  trainer::Device device = trainer::Device::automatic;

  // Only of gaussians and triangles.
  std::optional<std::int64_t> max_splats;
  std::optional<double> minutes;            // of training; the run fits its steps
  std::optional<std::uint64_t> max_memory;  // bytes; the run has fewer splats if it needs more

  // Only of gaussians.
  bool flat = false;  // discs

  // Only of triangles.
  bool opaque = false;  // the result is a triangle soup

  /// Whether a preset, a file or `published` is given. Single constants then change these instead
  /// of the constants of a checkpoint.
  bool name_a_base() const { return preset || published || !file.empty(); }
  /// The scene that provides the first primitives; empty: none.
  std::string mesh() const {
    return begin == "random" || begin == "points" ? std::string() : begin;
  }
};

/// The preset, with the file's constants. `otherwise`: the preset if neither names one. Throws
/// InputError for an invalid file, UsageError if it names another preset than `preset`.
trainer::Config base_config(const TrainingOptions& options, trainer::Preset otherwise);

/// `defaults` with the file's constants. Throws InputError for an invalid file.
trainer::GaussianConfig base_config(const TrainingOptions& options,
                                    const trainer::GaussianConfig& defaults);
trainer::WindowConfig base_config(const TrainingOptions& options,
                                  const trainer::WindowConfig& defaults);

/// `base` with the single constants. `triangles` scales the initial number of triangles in
/// proportion. `level` also limits the other levels. Throws UsageError for invalid constants.
trainer::Config with_options(const trainer::Config& base, const TrainingOptions& options);

/// The same for splats. `steps` sets minutes to 0 unless they are given, too.
trainer::GaussianConfig with_options(const trainer::GaussianConfig& base,
                                     const TrainingOptions& options);
trainer::WindowConfig with_options(const trainer::WindowConfig& base,
                                   const TrainingOptions& options);

/// All constants of the method as text: name, default, meaning, range or words.
std::string constants_reference(const TrainingOptions& options);

}  // namespace tureen
