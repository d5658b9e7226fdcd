// Holds the GL path against the oracle, which rasterises as GL does (Coverage::snapped).
//
// Two images agree where they cover the same pixels, name the same faces, and, where both name
// the same face, show the same colour up to its rounding to 8 bits. A pixel whose two depths, or
// whose alpha and threshold, float cannot tell apart may fall to the other side: hence budgets.
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

/// What GL drew. `faces` names one a pixel, and is empty where the plan shades forward.
struct Drawn {
  Image8 color;
  std::vector<std::uint32_t> faces;
};

/// One frame on a black background, on a context that is made current for it.
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
  double worst = 0;              // of a channel there
  double compared = 0;           // fraction of pixels where both name the same face
};

/// Both images have the same size, and GL's names faces.
Agreement agreement(const OracleImage& oracle, const Drawn& drawn);

struct AgreementLimits {
  /// Vertices that rounding in float sends to another 1/256 of a pixel, and alphas and depths that
  /// float cannot tell from the threshold or from each other: docs/numerics.md, H10.
  double max_coverage_mismatch = 1e-4;
  double max_face_mismatch = 1e-4;
  /// Rounding to 8 bits leaves 58.9 dB where errors are spread evenly over half a step to either
  /// side, and 54.2 where all of them are half a step. Of a few flat colours some may be close to
  /// that, all of them by chance never: 55 are nine tenths of half a step in every pixel.
  double min_psnr = 55.0;
  /// Of the image where both name the same face: below it there is hardly anything to compare.
  double min_compared = 0.05;
};

/// Fails unless they agree within the limits. Records what it measured as a property of the test.
/// `what` tells the comparisons of one test from each other, in messages and in the place of the
/// evidence: a failure leaves expected.png (the oracle's), actual.png, difference.png (enlarged)
/// and faces.png in BUILD/agreement/TEST/WHAT. The last shows in red what the oracle alone covers,
/// in green what GL alone covers, in blue where they name different faces.
void expect_agreement(const OracleImage& oracle, const Drawn& drawn, const std::string& what,
                      const AgreementLimits& limits = {});

}  // namespace tureen::test
