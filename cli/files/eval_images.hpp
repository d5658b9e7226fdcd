// The images of an evaluation: a PNG a view with the photograph, the rendering and a heat map of
// their differences side by side, and a contact sheet of them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "cli/report.hpp"
#include "image/image.hpp"
#include "jobs/eval/evaluation.hpp"
#include "scene/photographs.hpp"

namespace tureen::cli {

/// The names of the images in the folder: "train/r_0.png" gives "train_r_0.png". Letters other than
/// those that every file system takes become '_', and equal names get a number.
std::vector<std::string> image_names(std::span<const Photograph> photographs);

class EvalImages {
 public:
  /// Makes the folder. `spared` is the dataset's folder, or empty: in it no file is replaced, it
  /// may be a photograph. Throws UsageError where one would be, and OutputError.
  EvalImages(const std::filesystem::path& folder, const std::filesystem::path& spared,
             std::span<const Photograph> photographs);

  /// EvaluationOptions::on_view. Throws OutputError.
  void write(std::size_t view, const ImageF& photograph, const ImageF& rendering);

  /// Writes the contact sheet, where there is more than one view; returns all files that were
  /// written.
  std::vector<std::string> finish();

 private:
  std::filesystem::path folder_;
  std::vector<std::string> names_;
  std::vector<Image8> thumbnails_;  // of each view
};

/// {"name": .., "psnr_db": .., "ssim": .., "flip": ..}; no name where it has none.
Json to_json(const ViewMetrics& metrics, bool with_flip);

}  // namespace tureen::cli
