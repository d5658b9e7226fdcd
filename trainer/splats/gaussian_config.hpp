// All constants of the training of Gaussians, and the table that reads, writes, checks and
// documents them. Files have the form of those of soups (trainer/diffsoup/config_file.hpp).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "base/input.hpp"
#include "trainer/common/config_table.hpp"
#include "trainer/common/initialisation.hpp"

namespace tureen::trainer {

struct GaussianConfig {
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
  /// Scales have at least and at most this length, relative to the region's half side.
  float min_scale = 3e-4f, max_scale = 1;
  std::uint64_t seed = 0;
  Initialisation initialisation = Initialisation::automatic;
  /// Training time to which the run fits `steps`, in minutes; 0: `steps` as given.
  double minutes = 0;
};

using GaussianConfigField = BasicConfigField<GaussianConfig, Initialisation>;

/// All fields, in the order of GaussianConfig.
std::span<const GaussianConfigField> gaussian_config_fields();

/// The first error of the configuration; nothing if it is valid.
std::optional<std::string> defect(const GaussianConfig& config);

/// One flat JSON object. `defaults`: the values of fields that it does not name. Throws InputError
/// with the file and the field.
GaussianConfig read_gaussian_config(Input& input, const GaussianConfig& defaults = {});
GaussianConfig read_gaussian_config(const std::filesystem::path& path,
                                    const GaussianConfig& defaults = {});

/// All fields, one per line; read_gaussian_config returns the same bits from it.
std::string config_to_json(const GaussianConfig& config);

/// The first field that differs between a resumed run and its checkpoint; nothing if all are equal.
/// With minutes, the steps may differ: the checkpoint has fitted ones.
std::optional<std::string> difference(const GaussianConfig& now, const GaussianConfig& checkpoint);

/// All constants as text: name, default, meaning, range or words.
std::string gaussian_config_reference();

}  // namespace tureen::trainer
