// A pass of another program, made from the public interface of runtime/ and added to a Renderer.
#include <gtest/gtest.h>

#include "runtime/passes/pass.hpp"
#include "runtime/passes/shader_source.hpp"
#include "tests/support/contexts.hpp"
#include "tests/support/renderer_of.hpp"

namespace tureen {

namespace outside_pass_test {

constexpr glm::u8vec4 red(255, 0, 0, 255), green(0, 255, 0, 255), black(0, 0, 0, 255);

/// Fills the image at one distance from the eye, behind nearer triangles.
class Fog final : public Pass {
 public:
  Fog(gl::Api api, double distance)
      : distance_(distance),
        program_(assemble({.file = "full_screen.vert"}, api),
                 assemble({.file = "fog.frag",
                           .generated = {{"fog.frag",
                                          "layout(location = 0) out vec4 color;\n"
                                          "void main() { color = vec4(1.0, 0.0, 0.0, 1.0); }\n"}}},
                          api)) {}

  const char* name() const override { return "fog"; }
  void draw(const Frame& frame, FrameTarget& target) override {
    target.draw_color();
    const glm::dvec4 clip =
        target.clip_from_view(frame.input.camera, frame.range) * glm::dvec4(0, 0, -distance_, 1);
    program_.use();
    program_.set("background_depth", float(clip.z / clip.w));
    nothing_.bind();
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }
  void leave_context() override { nothing_.forget(); }

 private:
  double distance_;
  gl::Program program_;
  gl::LocalVertexArray nothing_;
};

/// A green triangle over the left half of the image, at distance 2.
TriangleSoup left_half() {
  TriangleSoup soup;
  soup.positions = {{0, -40, 0}, {0, 40, 0}, {-40, 0, 0}};
  soup.triangles = {{0, 1, 2}};
  soup.appearance = FaceColors{{{0.0f, 1.0f, 0.0f, 1.0f}}};
  return soup;
}

class OutsidePass : public testing::TestWithParam<test::NamedContext> {
 protected:
  gl::Context context = gl::Context::create(GetParam().request);
  Camera camera = look_at({0, 0, 2}, {0, 0, 0}, {0, 1, 0}, 0.8, 32, 16);

  /// The pixels in the middle of the left and of the right half.
  std::pair<glm::u8vec4, glm::u8vec4> halves(Renderer& renderer) {
    renderer.draw({camera});
    const Image8 image = renderer.read_color();
    return {image.at(8, 8), image.at(24, 8)};
  }
};

TEST_P(OutsidePass, DrawsBehindNearerTriangles) {
  for (const ShadingSite site : {ShadingSite::forward, ShadingSite::deferred})
    for (const int samples : {1, 2}) {
      Renderer renderer =
          renderer_of(context, left_half(), {},
                      {.plan = {.site = site, .quality = {.supersampling = samples}}});
      EXPECT_EQ(halves(renderer), std::pair(green, black)) << "without the pass";
      renderer.add_pass(std::make_unique<Fog>(context.capabilities().api, 3.0));
      EXPECT_EQ(halves(renderer), std::pair(green, red)) << "behind the triangle";
      renderer.leave_context();
      EXPECT_EQ(halves(renderer), std::pair(green, red)) << "in its context again";
      renderer.add_pass(std::make_unique<Fog>(context.capabilities().api, 1.0));
      EXPECT_EQ(halves(renderer), std::pair(red, red)) << "before the triangle";
    }
}

INSTANTIATE_TEST_SUITE_P(All, OutsidePass, testing::ValuesIn(test::every_context),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace outside_pass_test

}  // namespace tureen
