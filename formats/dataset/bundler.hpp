// A reconstruction by Bundler: bundle.out, version 0.3, and its list of images
// (https://www.cs.cornell.edu/~snavely/bundler/bundler-v0.4-manual.html, "Output format").
// VisualSFM, MVE, Metashape and others write it, too.
//
// A camera has a focal length f in pixels, k1, k2, a rotation R and a translation t. It sees the
// world point X at P = R X + t, looks along -z and has y up, as in OpenGL. With p = -P.xy / P.z,
// the point appears f (1 + k1 |p|^2 + k2 |p|^4) p pixels from the centre of the image.
#pragma once

#include <filesystem>
#include <glm/mat4x4.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "formats/dataset/lens.hpp"
#include "scene/photographs.hpp"

namespace tureen {

struct BundlerCamera {
  double focal = 0;  // in pixels; 0 for an image that the reconstruction does not have
  Lens lens;
  glm::dmat4 view_from_world{1.0};
};

struct BundlerModel {
  std::vector<BundlerCamera> cameras;  // in the order of the list of images
  std::vector<DatasetPoint> points;
};

/// Throws InputError with the line: another version, a number missing or not finite, a negative
/// focal length, a rotation that is not one to three digits, a list of views that does not have
/// four numbers for each view. A text after the last point is ignored.
BundlerModel read_bundler(Input& input);

/// The names of images, one a line, without blank lines. A "0" and a focal length after a name are
/// an estimate, and ignored. Two blanks in a row within a name become one. Throws InputError with
/// the line if it has more than 4,096 bytes.
std::vector<std::string> read_bundler_list(Input& input);

struct BundlerFiles {
  std::filesystem::path model, list;
};

/// `bundle.out` in `dataset` or its folder `bundle`, and its list in either folder: `list.txt` or
/// `bundle.out.list.txt`, or an empty path without one. nullopt without bundle.out.
std::optional<BundlerFiles> bundler_files(const std::filesystem::path& dataset);

}  // namespace tureen
