#include "cli/files/measured_images.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "base/error.hpp"
#include "base/extension.hpp"
#include "base/output.hpp"
#include "cli/files/image_file.hpp"
#include "cli/progress.hpp"
#include "image/exr.hpp"
#include "image/png_rows.hpp"
#include "runtime/debug_views/debug_views.hpp"
#include "runtime/renderer.hpp"
#include "scene/clip_range.hpp"

namespace tureen::cli {

namespace {

/// Values of a view, row by row from the top; the fourth component is 0 where nothing is visible.
using Values = std::vector<glm::vec4>;

bool is_depth(DebugView what) {
  return what == DebugView::depth || what == DebugView::median_depth;
}

std::vector<float> channel(const Values& values, int component, float nothing) {
  std::vector<float> result;
  result.reserve(values.size());
  for (const glm::vec4& value : values) result.push_back(value.w > 0 ? value[component] : nothing);
  return result;
}

std::vector<std::byte> exr_of(const Values& values, const Camera& camera, DebugView what) {
  const float nothing = is_depth(what) ? std::numeric_limits<float>::infinity() : 0.0f;
  const std::string names = what == DebugView::normals ? "RGB" : is_depth(what) ? "Z" : "A";
  std::array<std::vector<float>, 3> channels;
  std::vector<ExrChannel> named;
  for (std::size_t c = 0; c < names.size(); ++c) {
    channels[c] = channel(values, int(c), nothing);
    named.push_back({std::string(1, names[c]), channels[c]});
  }
  return encode_exr(camera.width, camera.height, std::move(named));
}

/// Of a value in [0, 1].
std::uint16_t word(double value, double steps = 65535) {
  return std::uint16_t(std::lround(std::clamp(value, 0.0, 1.0) * steps));
}

void write_png(const Values& values, const Camera& camera, const MeasuredImage& image) {
  const bool normals = image.what == DebugView::normals;
  std::vector<std::uint16_t> words;
  for (const glm::vec4& value : values) {
    const bool visible = value.w > 0;
    if (normals) {
      for (int c = 0; c < 3; ++c) words.push_back(visible ? word(0.5 + 0.5 * value[c]) : 0);
    } else if (is_depth(image.what)) {
      const double part = (double(value.x) - image.near) / (image.far - image.near);
      words.push_back(visible ? std::uint16_t(1 + word(part, 65534)) : 0);
    } else {
      words.push_back(word(double(value.x)));
    }
  }
  Output output(image.path);
  PngRows rows(output, camera.width, camera.height, normals ? PngPixels::rgb16 : PngPixels::grey16);
  rows.append(words);
  rows.finish();
  output.commit();
}

ClipRange range_of(const Scene& scene, const Camera& camera) {
  std::vector<LayerPlace> boxes;
  for (const Layer& layer : scene.layers)
    if (layer.visible) boxes.push_back({bounds(layer), layer.world_from_layer});
  return clip_range(boxes, camera, DepthStorage::reversed_float);
}

}  // namespace

void add_measured_outputs(Command& command, MeasuredOutputs& outputs) {
  const char* meanings[] = {
      "mean depth of each pixel, weighted by contribution: the distance along the viewing axis in "
      "world units",
      "depth at which the transmittance falls to 1/2, in world units",
      "mean normal of each pixel, weighted by contribution: x, y, z in world axes",
      "1 - transmittance of each pixel; 1 on triangles"};
  for (std::size_t i = 0; i < outputs.list.size(); ++i)
    command.add_option(std::string(outputs.list[i].option) + " FILE", outputs.list[i].pattern,
                       std::string("also write the ") + meanings[i] +
                           "; names as for --output; .exr (32-bit floats) or .png (16 bits, "
                           "docs/debug-views.md)");
}

void require_measured_names(const MeasuredOutputs& outputs, const std::string& image) {
  std::set<std::filesystem::path> names{std::filesystem::path(image).lexically_normal()};
  for (const MeasuredOutput& each : outputs.list) {
    if (each.pattern.empty()) continue;
    const std::string extension = extension_of(each.pattern);
    if (extension != ".exr" && extension != ".png")
      throw UsageError(
          fmt::format("{}: '{}' ends in neither .exr nor .png", each.option, each.pattern));
    if (!names.insert(std::filesystem::path(each.pattern).lexically_normal()).second)
      throw UsageError(fmt::format("{}: '{}' is also another output", each.option, each.pattern));
  }
}

void require_measured_sizes(const gl::Capabilities& device, const std::vector<Camera>& cameras,
                            const MeasuredOutputs& outputs) {
  for (const MeasuredOutput& output : outputs.list)
    for (const Camera& camera : cameras)
      if (!output.pattern.empty() && std::max(camera.width, camera.height) > device.max_image_side)
        throw UsageError(fmt::format("{} supports images of at most {} pixels a side",
                                     output.option, device.max_image_side));
}

std::vector<MeasuredImage> write_measured(const gl::Context& context, const Scene& scene,
                                          const std::vector<Camera>& cameras,
                                          const MeasuredOutputs& outputs) {
  const gl::Capabilities& device = context.capabilities();
  const std::vector<PlacedLayer> layers = placed_layers(scene);
  std::vector<MeasuredImage> written;
  DebugViews views(layers);
  Renderer renderer(context, prepare_debug_views(layers, device_limits(device)));
  Progress progress("measuring");
  for (const MeasuredOutput& output : outputs.list) {
    if (output.pattern.empty()) continue;
    views.measure(renderer, output.what);
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      progress.update(double(i) / double(cameras.size()));
      const Camera& camera = cameras[i];
      renderer.draw({camera});
      MeasuredImage image{.path = image_name(output.pattern, int(i), int(cameras.size())).string(),
                          .what = output.what};
      const Values values = views.read_values();
      if (extension_of(image.path) == ".exr") {
        write_file(image.path, exr_of(values, camera, output.what));
      } else {
        if (is_depth(output.what)) {
          const ClipRange range = range_of(scene, camera);
          image.near = range.near;
          image.far = range.far;
        }
        write_png(values, camera, image);
      }
      written.push_back(std::move(image));
    }
  }
  return written;
}

}  // namespace tureen::cli
