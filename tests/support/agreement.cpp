#include "tests/support/agreement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "jobs/baseline/baseline.hpp"
#include "runtime/renderer.hpp"
#include "tests/support/evidence.hpp"
#include "tests/support/renderer_of.hpp"

namespace tureen::test {

namespace {

/// The folder of `what` in BUILD/agreement. Slashes in a parameterised test's name do not become
/// folders.
std::filesystem::path evidence_folder(const std::string& what) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test->test_suite_name()) + "." + test->name();
  std::replace(name.begin(), name.end(), '/', '.');
  return std::filesystem::path(TUREEN_BINARY_DIR) / "agreement" / name / what;
}

enum class Pixel { background, same_face, oracle_alone, gl_alone, other_face };

Pixel pixel(std::uint32_t oracle_face, std::uint32_t gl_face) {
  if (oracle_face == gl_face) return gl_face == no_face ? Pixel::background : Pixel::same_face;
  if (gl_face == no_face) return Pixel::oracle_alone;
  if (oracle_face == OracleImage::no_face) return Pixel::gl_alone;
  return Pixel::other_face;
}
static_assert(no_face == OracleImage::no_face);

Image8 image_of_faces(const OracleImage& oracle, const Drawn& drawn) {
  Image8 result(drawn.color.width, drawn.color.height, glm::u8vec4(0, 0, 0, 255));
  for (std::size_t i = 0; i < drawn.faces.size(); ++i)
    switch (pixel(oracle.face[i], drawn.faces[i])) {
      case Pixel::background:
        break;
      case Pixel::same_face:
        result.pixels[i] = {64, 64, 64, 255};
        break;
      case Pixel::oracle_alone:
        result.pixels[i] = {255, 0, 0, 255};
        break;
      case Pixel::gl_alone:
        result.pixels[i] = {0, 255, 0, 255};
        break;
      case Pixel::other_face:
        result.pixels[i] = {0, 128, 255, 255};
        break;
    }
  return result;
}

}  // namespace

Drawn draw(gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera,
           const PlanPreferences& plan) {
  context.make_current();
  Renderer renderer = renderer_of(context, soup, origin, {.plan = plan, .limits = {}});
  renderer.draw({camera});
  return {renderer.read_color(), faces_of(renderer)};
}

Drawn draw_baseline(gl::Context& context, const TriangleSoup& soup, glm::dvec3 origin,
                    const Camera& camera) {
  context.make_current();
  Renderer renderer = make_renderer(context, soup, origin, PipelineKind::baseline);
  renderer.draw({camera});
  return {renderer.read_color(), {}};
}

OracleImage snapped_oracle(const TriangleSoup& soup, glm::dvec3 origin, const Camera& camera,
                           oracle::Attributes attributes) {
  return render_oracle(soup, origin, {camera},
                       {.rays = {.coverage = oracle::Coverage::snapped, .attributes = attributes}});
}

Agreement agreement(const OracleImage& oracle, const Drawn& drawn) {
  if (oracle.face.size() != drawn.faces.size()) {
    ADD_FAILURE() << "the oracle has " << oracle.face.size() << " pixels, GL names faces of "
                  << drawn.faces.size();
    return {};
  }
  std::size_t coverage = 0, other = 0, same = 0;
  double squares = 0;
  std::vector<double> differences;
  Agreement result;
  for (std::size_t i = 0; i < drawn.faces.size(); ++i) {
    const Pixel found = pixel(oracle.face[i], drawn.faces[i]);
    coverage += found == Pixel::oracle_alone || found == Pixel::gl_alone;
    other += found == Pixel::other_face;
    if (found != Pixel::same_face) continue;
    ++same;
    for (int c = 0; c < 3; ++c) {
      const double d = double(oracle.color.pixels[i][c]) - drawn.color.pixels[i][c] / 255.0;
      squares += d * d;
      differences.push_back(std::abs(d));
    }
  }
  if (!differences.empty()) {
    std::sort(differences.begin(), differences.end());
    result.worst = differences.back();
    result.percentile_999 = differences[(differences.size() - 1) * 999 / 1000];
  }
  const auto pixels = double(drawn.faces.size());
  result.coverage_mismatch = double(coverage) / pixels;
  result.face_mismatch = double(other) / pixels;
  result.psnr = 10 * std::log10(3.0 * double(same) / std::max(squares, 1e-12));
  result.compared = double(same) / pixels;
  return result;
}

void expect_agreement(const OracleImage& oracle, const Drawn& drawn, const std::string& what,
                      const AgreementLimits& limits) {
  const std::filesystem::path folder = evidence_folder(what);
  std::filesystem::remove_all(folder);
  const Agreement found = agreement(oracle, drawn);
  std::ostringstream numbers;
  numbers << "coverage mismatch " << found.coverage_mismatch << ", face mismatch "
          << found.face_mismatch << ", " << found.psnr << " dB, worst " << found.worst << ", "
          << found.compared << " of the image compared";
  std::string key = what;
  std::replace(key.begin(), key.end(), ' ', '_');  // the key becomes an attribute's name in XML
  testing::Test::RecordProperty(key, numbers.str());
  if (found.coverage_mismatch <= limits.max_coverage_mismatch &&
      found.face_mismatch <= limits.max_face_mismatch && found.psnr >= limits.min_psnr &&
      found.compared >= limits.min_compared)
    return;
  ADD_FAILURE() << what << ": " << numbers.str() << "; see " << folder;
  if (oracle.face.size() != drawn.faces.size()) return;
  const Image8 expected = quantised(oracle.color);
  write_evidence(expected, folder, "expected");
  write_evidence(drawn.color, folder, "actual");
  write_evidence(enlarged_difference(expected, drawn.color), folder, "difference");
  write_evidence(image_of_faces(oracle, drawn), folder, "faces");
}

}  // namespace tureen::test
