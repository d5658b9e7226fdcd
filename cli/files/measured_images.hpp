// Depths, normals and alpha of the views as files: OpenEXR with 32-bit floats, or PNG with 16 bits.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "cli/options/arguments.hpp"
#include "runtime/debug_views/debug_view.hpp"
#include "runtime/gl/context.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

/// One kind of value to write.
struct MeasuredOutput {
  DebugView what;
  const char* option;        // "--depth"
  std::string pattern = {};  // of image_name(); empty: not written
};

/// Depth, median depth, normals and alpha.
struct MeasuredOutputs {
  std::vector<MeasuredOutput> list = {{DebugView::depth, "--depth"},
                                      {DebugView::median_depth, "--median-depth"},
                                      {DebugView::normals, "--normals"},
                                      {DebugView::alpha, "--alpha"}};
  /// Whether any is written.
  bool any() const {
    return std::any_of(list.begin(), list.end(),
                       [](const MeasuredOutput& each) { return !each.pattern.empty(); });
  }
};

void add_measured_outputs(Command& command, MeasuredOutputs& outputs);

/// Throws UsageError for names that do not end in .exr or .png, and for a name that two outputs
/// have; `image` is the name of the images themselves.
void require_measured_names(const MeasuredOutputs& outputs, const std::string& image);

struct MeasuredImage {
  std::string path;
  DebugView what;
  /// Of depths in a PNG: those of the values 1 and 65535. Otherwise 0.
  double near = 0, far = 0;
};

/// Throws UsageError if an image is larger than the device supports: measured images have no tiles.
void require_measured_sizes(const gl::Capabilities& device, const std::vector<Camera>& cameras,
                            const MeasuredOutputs& outputs);

/// Writes one file for each output and camera; require_measured_sizes() has accepted them. Values
/// have one sample per pixel. Where nothing is visible: depth infinity (PNG: 0), normal 0, alpha 0.
/// Throws OutputError.
std::vector<MeasuredImage> write_measured(const gl::Context& context, const Scene& scene,
                                          const std::vector<Camera>& cameras,
                                          const MeasuredOutputs& outputs);

}  // namespace tureen::cli
