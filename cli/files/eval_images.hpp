// The images of an evaluation, and a contact sheet of them: one PNG per view with the photograph,
// the rendering, a heat map of their differences, and holes and specks side by side.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "image/image.hpp"
#include "jobs/eval/evaluation.hpp"
#include "scene/photographs.hpp"

namespace tureen::cli {

/// The names of the images in the folder: "train/r_0.png" gives "train_r_0.png". Characters other
/// than ASCII letters, digits, '-' and '.' become '_'; equal names get a number.
std::vector<std::string> image_names(std::span<const Photograph> photographs);

class EvalImages {
 public:
  /// Creates the folder. `spared`: the dataset's folder, or empty. Throws UsageError if an image
  /// would replace a file in it, because the file may be a photograph. Throws OutputError.
  EvalImages(const std::filesystem::path& folder, const std::filesystem::path& spared,
             std::span<const Photograph> photographs);

  /// EvaluationOptions::on_view. Throws OutputError.
  void write(std::size_t view, const ImageF& photograph, const ImageF& rendering);

  /// Writes the contact sheet if there is more than one view. Returns all written files.
  std::vector<std::string> finish();

 private:
  std::filesystem::path folder_;
  std::vector<std::string> names_;
  std::vector<Image8> thumbnails_;  // of each view
};

}  // namespace tureen::cli
