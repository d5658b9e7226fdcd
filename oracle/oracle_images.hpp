// Whole images by the oracle.
#pragma once

#include "oracle/oracle.hpp"
#include "scene/image_source.hpp"

namespace tureen {

/// The image over options.background, or of the covered part without one; alpha is coverage, the
/// mean of the rays: 1 with a hit, otherwise the alpha of the splats. Memory in addition to the
/// image: 12 bytes a ray, 88 with splats, in strips of `rows` rows. With Coverage::snapped, the
/// strip must be the whole image: clipping depends on its border. Uses one thread.
ImageF oracle_image(const Scene& scene, const FrameInput& input, OracleOptions options, int rows);

/// Draws strips of rows on all cores. options.progress is called by the caller's thread.
class OracleImages final : public ImageSource {
 public:
  /// `scene` outlives the object. `options` has Coverage::exact.
  OracleImages(const Scene& scene, OracleOptions options)
      : scene_(scene), options_(std::move(options)) {}

  Image8 image(const FrameInput& input) override { return quantised(*exact_image(input)); }
  std::optional<ImageF> exact_image(const FrameInput& input) override;

 private:
  const Scene& scene_;
  OracleOptions options_;
};

}  // namespace tureen
