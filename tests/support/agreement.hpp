// Compares the GL path with the oracle, which rasterises as GL does (Coverage::snapped).
//
// Two images agree if they cover the same pixels with the same faces. Where both name the same
// face, the colours must be equal up to rounding to 8 bits. In float, two depths, or alpha and
// threshold, may be indistinguishable. Such pixels may differ, hence the limits.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "image/image.hpp"
#include "oracle/oracle.hpp"
#include "runtime/gl/context.hpp"
#include "runtime/plan/plan.hpp"
#include "scene/camera.hpp"
#include "scene/triangle_soup.hpp"

namespace tureen::test {

/// An image by GL. `faces` has the face of each pixel, and is empty if the plan shades forward.
struct Drawn {
  Image8 color;
  std::vector<std::uint32_t> faces;
};

/// Draws one frame on a black background, and makes the context current.
Drawn draw(gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera,
           const PlanPreferences& plan = {.site = ShadingSite::deferred});

/// The same frame by the baseline, which names no faces.
Drawn draw_baseline(gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                    const Camera& camera);

/// The oracle's image of the same frame, rasterised as GL does.
OracleImage snapped_oracle(const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera,
                           oracle::Attributes attributes = oracle::Attributes::unsnapped);

struct Agreement {
  double coverage_mismatch = 0;  // fraction of pixels that only one of the two covers
  double face_mismatch = 0;      // fraction of pixels that both cover, with different faces
  double psnr = 0;               // dB, over the pixels where both name the same face
  double worst = 0;              // largest difference of a channel there
  double percentile_999 = 0;     // and the 99.9th percentile
  double compared = 0;           // fraction of pixels where both name the same face
};

/// Both images must have the same size, and `drawn` must have faces.
Agreement agreement(const OracleImage& oracle, const Drawn& drawn);

struct AgreementLimits {
  /// In float, rounding moves some vertices to another 1/256 of a pixel. Also, alphas and depths
  /// may be indistinguishable from the threshold or from each other: docs/numerics.md, H10.
  double max_coverage_mismatch = 1e-4;
  double max_face_mismatch = 1e-4;
  /// In dB. Rounding to 8 bits gives 58.9 dB if errors are uniform within half a step, and 54.2 if
  /// all of them are half a step. With few flat colours, some errors may be close to that, but not
  /// all of them: 55 dB is nine tenths of half a step in every pixel.
  double min_psnr = 55.0;
  /// Fraction of the image where both name the same face: below it, there is too little to compare.
  double min_compared = 0.05;
};

/// Fails unless they agree within the limits. Records the measured values as a property of the
/// test. `what` distinguishes the comparisons of one test, in messages and in the path of the
/// evidence. A failure writes expected.png (by the oracle), actual.png, difference.png (enlarged)
/// and faces.png into BUILD/agreement/TEST/WHAT. In faces.png, red pixels are covered only by the
/// oracle, green ones only by GL, and blue ones by different faces.
void expect_agreement(const OracleImage& oracle, const Drawn& drawn, const std::string& what,
                      const AgreementLimits& limits = {});

}  // namespace tureen::test
