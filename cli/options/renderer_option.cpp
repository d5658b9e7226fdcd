#include "cli/options/renderer_option.hpp"

#include <utility>
#include <vector>

#include "base/error.hpp"
#include "oracle/oracle_images.hpp"
#include "runtime/splats/tile_images.hpp"
#include "tracing/traced_images.hpp"

namespace tureen::cli {

namespace {

bool is_along_rays(const Quality& quality) {
  if (quality.splat_order == Quality::SplatOrder::stochastic)
    throw UsageError("only --renderer gl draws splats in stochastic order",
                     "choose another order with --splat-order");
  return quality.splat_order == Quality::SplatOrder::exact;
}

std::unique_ptr<ImageSource> oracle_images(const Scene& scene, const ProcessorImages& images) {
  const auto order =
      is_along_rays(images.quality) ? oracle::SplatOrder::exact : oracle::SplatOrder::center;
  return std::make_unique<OracleImages>(scene,
                                        OracleOptions{.supersampling = images.quality.supersampling,
                                                      .splat_order = order,
                                                      .background = images.background,
                                                      .progress = images.progress});
}

std::unique_ptr<ImageSource> tile_images(const Scene& scene, const ProcessorImages& images) {
  if (images.quality.supersampling > 1)
    throw UsageError("--renderer tiles supports only one sample per pixel",
                     "draw with --supersample 1");
  const auto order = is_along_rays(images.quality) ? splatting::BlendOrder::along_rays
                                                   : splatting::BlendOrder::centers;
  return std::make_unique<TileImages>(scene, images.background, order);
}

std::unique_ptr<ImageSource> traced_images(const Scene& scene, const ProcessorImages& images) {
  const int side = images.quality.supersampling;
  if (side > 1 && images.samples > 1)
    throw UsageError("--samples and --supersample exclude each other", "remove one of them");
  return std::make_unique<tracing::TracedImages>(
      scene, tracing::TraceOptions{.samples = images.samples,
                                   .supersampling = side,
                                   .background = images.background,
                                   .progress = images.progress});
}

constexpr ProcessorRenderer renderers[] = {
    {"oracle", oracle_images}, {"tiles", tile_images}, {"trace", traced_images}};
constexpr const ProcessorRenderer& rays = renderers[2];

/// Options of `render` that OpenGL alone supports.
constexpr const char* gl_options[] = {
    "--debug-view", "--scale", "--pipeline",     "--shading", "--no-specialise",
    "--keep",       "--blend", "--context",      "--frames",  "--as-published",
    "--depth",      "--alpha", "--median-depth", "--normals"};

}  // namespace

RendererChoice ray_renderer() { return {&rays}; }

void add_samples_option(Command& command, RendererChoice& choice) {
  command.add_option("--samples N", choice.samples,
                     "jittered samples per pixel, 1 by default; needs --renderer trace",
                     between(1, 4096));
}

std::function<void()> add_renderer_option(Command& command, RendererChoice& choice,
                                          const std::string& own) {
  std::vector<std::pair<std::string, const ProcessorRenderer*>> choices{{"gl", nullptr}};
  for (const ProcessorRenderer& each : renderers) choices.emplace_back(each.name, &each);
  add_choice(command, "--renderer NAME", choice.renderer, std::move(choices),
             "renderer: gl (default; needs OpenGL); oracle: the reference in double precision, "
             "seconds to hours per image; tiles: splats on the CPU; trace: rays, with mirrors, "
             "glass and splats in exact order");
  add_samples_option(command, choice);
  std::vector<std::pair<std::string, Option>> options;
  for (const char* name : gl_options)
    if (name != own && command.has_option(name)) options.emplace_back(name, command.option(name));
  return [&choice, options = std::move(options)] {
    if (choice.samples > 1 && choice.renderer != &rays)
      throw UsageError("--samples needs --renderer trace",
                       "add it, or use --supersample, which all renderers support");
    if (!choice.renderer) return;
    for (const auto& [name, option] : options)
      if (option.is_given())
        throw UsageError(name + " needs --renderer gl",
                         "remove " + name + ", or --renderer " + choice.renderer->name);
  };
}

}  // namespace tureen::cli
