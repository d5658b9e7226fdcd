// Whether a scene's preset holds what it promises, here and now: four small views are drawn with it
// and without, and where they differ by more than was promised the scene is drawn faithfully. A
// file may have been changed since, or the device may round otherwise.
#pragma once

#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/renderer.hpp"
#include "soup/scene.hpp"

namespace tureen {

/// The four views: the first camera and the middle one of the scene, or where it has none a view
/// from the front and one from behind; from close by, and from far away. Each side is a quarter of
/// the camera's, or of 1280x720, and at least 64 pixels. The same for the same scene, whose
/// primitives are a TriangleSoup.
std::vector<Camera> preset_views(const Scene& scene);

/// PSNR in dB between two renderers of one scene, of the mean squared error over all views
/// together; at most 100. Leaves both with another size of frame.
double psnr_between(Renderer& a, Renderer& b, std::span<const Camera> views);

/// What RenderPreset::promised_psnr_db is made of, when a preset is chosen: psnr_between a faithful
/// renderer and one with the preset, over preset_views().
double measured_promise(const gl::Context& context, const Scene& scene, const RenderPreset& preset);

/// By how much a device may miss the promise of another: theirs round colours and edges otherwise.
/// Coverage is not looked at by itself: a mean squared error of 1e-5, which is 50 dB, has no room
/// for more than a part of 1e-4 of the pixels, the bound of the choice, that are covered otherwise
/// and differ by a third of full scale; what differs by less hardly shows.
inline constexpr double promise_slack_db = 0.5;

struct CheckedRenderer {
  Renderer renderer;
  /// What became of the preset, in a sentence; empty where there was none, or a faithful one.
  std::string sentence;
  bool obeys_preset = false;
};

/// What a scene says of how it is to be drawn.
struct ScenePreset {
  std::optional<RenderPreset> preset = {};  // Scene::preset
  std::vector<Camera> views = {};           // preset_views()
};

/// A preset as far as it can be checked without its soup.
struct PresetPromise {
  std::string knobs;  // describe()
  std::optional<double> psnr_db = {};
  std::vector<Camera> views = {};  // preset_views()
};
PresetPromise promise_of_preset(const RenderPreset& preset);

/// How to come by a renderer with the preset and one without. Each is called once at most;
/// `with_preset` may throw UsageError or DeviceLimitError, and then the preset is not obeyed.
struct PresetCandidates {
  std::function<Renderer()> with_preset;
  std::function<Renderer()> without;
};

/// Whichever may be shown: the one with the preset if over the views it comes as near to the other
/// as was promised, or nothing was promised.
CheckedRenderer checked_renderer(const PresetPromise& promise, const PresetCandidates& candidates);

/// A renderer that obeys the scene's preset if it holds: over its views it comes as near to
/// faithful pictures as it promised, or nothing was promised. One that misses its promise, that
/// this pipeline or device does not know or that makes no sense for this soup is not obeyed. The
/// knobs of options.plan.preset are what the caller asks for himself: they are obeyed in any case,
/// before the scene's (combined()), and the faithful pictures have them too. Throws what the
/// Renderer throws without the scene's preset.
CheckedRenderer checked_renderer(const gl::Context& context, const TriangleSoup& soup,
                                 glm::dvec3 origin, const RenderOptions& options,
                                 const ScenePreset& scene);

}  // namespace tureen
