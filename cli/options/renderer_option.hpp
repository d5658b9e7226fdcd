// --renderer: what draws images. OpenGL does by default; the renderers here need none.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "cli/options/arguments.hpp"
#include "runtime/renderer.hpp"
#include "scene/image_source.hpp"
#include "scene/scene.hpp"

namespace tureen::cli {

struct ProcessorImages {
  Quality quality;
  std::optional<glm::vec3> background;   // nullopt: transparent
  std::function<void(double)> progress;  // called with the fraction done of an image
  int samples = 1;                       // jittered, for each pixel; only rays support more
};

/// Draws whole images on the CPU.
struct ProcessorRenderer {
  const char* name;  // as --renderer takes it
  /// The scene must outlive the result. Throws UsageError for what it does not support.
  std::unique_ptr<ImageSource> (*make)(const Scene& scene, const ProcessorImages& images);
};

struct RendererChoice {
  const ProcessorRenderer* renderer = nullptr;  // null: OpenGL
  int samples = 1;                              // ProcessorImages::samples
};
/// Draws by rays.
RendererChoice ray_renderer();

/// Adds --samples, for commands that draw by rays.
void add_samples_option(Command& command, RendererChoice& choice);

/// Adds --renderer and --samples, after all other options. The returned function throws UsageError
/// if a processor renderer is chosen and an option is given that only OpenGL supports; call it
/// after parsing. `own`: an option of the command that means something else than render's of this
/// name, or empty.
std::function<void()> add_renderer_option(Command& command, RendererChoice& choice,
                                          const std::string& own = {});

}  // namespace tureen::cli
