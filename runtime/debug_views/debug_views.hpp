// Shows the debug views of runtime/debug_views/debug_view.hpp: prepares layers for them, and gives
// its Renderer the passes of one of them.
#pragma once

#include <memory>
#include <vector>

#include "runtime/debug_views/debug_view.hpp"
#include "runtime/renderer.hpp"

namespace tureen {

/// Prepares soups with all their faces and all their stored values. Of their specialisations, only
/// weight_uniforms and dead_neurons are applied; they are exact. The Renderer also draws ordinary
/// frames. Of the options' preferences, only reversed_depth has an effect. Otherwise as
/// prepare_scene.
PreparedScene prepare_debug_views(std::span<const PlacedLayer> layers, const DeviceLimits& device,
                                  const RenderOptions& options = {});

/// The debug views of a scene. After show(), the renderer's passes refer to this object, also for
/// DebugView::color. It must live until the renderer is destroyed or gets other passes.
class DebugViews {
 public:
  /// The layers are not needed afterwards.
  explicit DebugViews(std::span<const PlacedLayer> layers);
  ~DebugViews();
  DebugViews(DebugViews&&) noexcept;
  DebugViews& operator=(DebugViews&&) noexcept;

  /// Throws UsageError with the sentence of why_not() if a layer has no such debug view.
  void require(DebugView what, const FeatureChoice& features = {}) const;

  /// Selects the debug view that the renderer draws in the next frames. The renderer must come from
  /// prepare_debug_views for these layers. All calls must pass the same renderer. Throws as
  /// require().
  ///
  /// A pixel shows the face or background of an ordinary frame, with three exceptions for fragments
  /// that the alpha test rejects. DebugView::alpha shows the nearest face even if it is rejected,
  /// overdraw counts every fragment, and the wireframe outlines whole triangles if nothing is in
  /// front of them. Renderer::read_faces() is empty for overdraw.
  void show(Renderer& renderer, DebugView what, const FeatureChoice& features = {});

  /// Selects values instead of colours, for read_values(). Not for DebugView::color, quarter, and
  /// views that only soups have. Otherwise as show().
  void measure(Renderer& renderer, DebugView what);

  /// The values of the last frame after measure(), for each pixel, row 0 on top. The fourth
  /// component is 1; where nothing is visible, all four are 0. A soup counts as the last, opaque
  /// contribution to the other three:
  /// - depth: the mean view depth, weighted by contribution, in world units, three times
  /// - median_depth: that at which the transmittance falls to 1/2 or below
  /// - normals: the weighted mean, of unit length, in world axes; 0 if normals cancel
  /// - alpha: 1 - transmittance
  /// - opacity, sigma: the weighted means of the stored values
  /// - overdraw: blended splats in front of the soups, and all fragments of the soups
  /// - contributions: splats in front of the one that would lower the transmittance below 1e-4
  /// - order: the place of the first splat in the order of blending, from 0
  /// For what depth and normal of a splat are, see SplatMeasures.
  std::vector<glm::vec4> read_values() const;

  /// The fragment count of each pixel of the last overdraw frame of soups, row 0 on top, at most
  /// max_counted_fragments; empty for other debug views.
  std::vector<std::uint8_t> read_fragment_counts() const;

  /// Legend of the last frame's colours.
  Legend legend() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace tureen
