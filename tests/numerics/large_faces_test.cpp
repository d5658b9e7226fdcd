// Face indices that floats cannot represent: case T7b. T7 covers the texels of such a face.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "runtime/gl/program.hpp"
#include "runtime/gl/state.hpp"
#include "runtime/passes/frame_target.hpp"
#include "runtime/passes/geometry.hpp"
#include "runtime/passes/shader_source.hpp"
#include "tests/numerics/recorder.hpp"
#include "tests/numerics/scenes.hpp"
#include "tests/support/shader_probe.hpp"
#include "trainer/diffsoup/cuda/device_image.hpp"

namespace tureen::test {
namespace large_faces_test {

/// Draws one vertex as a point, as faces are drawn, and reads its face's index. There are no
/// buffers, so face indices may be arbitrarily large; all vertices are at the origin.
class NamedByDevice {
 public:
  NamedByDevice()
      : program_(assemble({.file = "geometry.vert"}, api()),
                 assemble({.file = "visibility.frag",
                           .constants = {{"ALPHA_TEST", "0"}},
                           .generated = {{"appearance.glsl", ""}}},
                          api())),
        target_({.visibility = true}) {
    target_.resize({1, 1});
  }

  std::uint32_t name_of(std::uint32_t face) {
    Camera camera = straight_camera(1, 1, 1);
    camera.view_from_world[3] = glm::dvec4(0, 0, -1, 1);
    gl::use_plain_rasterisation(1, 1);
    target_.begin(glm::vec4(0.0f));
    target_.draw_visibility(0);
    glDisable(GL_DEPTH_TEST);
    program_.use();
    Geometry::set_camera(program_, {camera, camera.eye(), {0.01, 100}},
                         clip_from_view_reversed(camera, 0.01));
    glBindVertexArray(nothing_.id());
    glDrawArrays(GL_POINTS, int(3 * face), 1);
    glFinish();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target_.visibility_framebuffer());
    std::uint32_t fragment[4] = {};
    glReadPixels(0, 0, 1, 1, GL_RGBA_INTEGER, GL_UNSIGNED_INT, fragment);
    return fragment[0];
  }

 private:
  static gl::Api api() { return shared_context().capabilities().api; }

  gl::Program program_;
  FrameTarget target_;
  gl::VertexArray nothing_ = gl::VertexArray::create();
};

/// The index of a face's first texel at level 0: computes the shader's texel position and converts
/// it back to an index.
class TexelOnDevice {
 public:
  std::uint64_t first_texel_of(std::uint32_t face) const {
    // Numbers above 2^24 are passed as two halves of 16 bits.
    const glm::vec4 place =
        probe_.run({glm::vec4(float(face >> 16), float(face & 0xffffu), 0, 0)}).front();
    return std::uint64_t(place.x) + (std::uint64_t(place.y) << row_bits) +
           (std::uint64_t(place.z) << (row_bits + layer_bits));
  }

 private:
  static constexpr int row_bits = 12, layer_bits = 9;

  Probe probe_{shared_context().capabilities().api,
               "#include \"appearance_lattice.glsl\"\n"
               "vec4 probe(vec4 x) { uint face = uint(x.x) * 65536u + uint(x.y);"
               " return vec4(vec3(texel_position(patch_of(face).first_texel)), 0.0); }",
               {{"LATTICE_LEVEL", "0"},
                {"LATENT_FEATURES", "0"},
                {"ALPHA_BY_CELL", "0"},
                {"LATTICE_HARMONICS", "0"},
                {"COLOR_MLP", "0"},
                {"ALPHA_THRESHOLD", "0.5"},
                {"TEXEL_ROW_BITS", std::to_string(row_bits)},
                {"TEXEL_LAYER_BITS", std::to_string(layer_bits)}}};
};

TEST(Numerics, T7b_FacesBeyondTwoToThe24KeepTheirNames) {
  Recorder recorder({.stressed = "the index of a face from its vertex to the image: geometry.vert "
                                 "and visibility.frag; on to its texels at level 0; and in a key "
                                 "of the trainer on a GPU",
                     .parameter = "face",
                     .unit = "of the three indices that arrive changed",
                     .naive = "indices that pass through a float"});
  NamedByDevice device;
  const TexelOnDevice texel;
  // The last index is the largest whose vertices OpenGL can count.
  for (const std::uint32_t face :
       {0u, (1u << 24) - 1, (1u << 24) + 1, (1u << 25) + 1, 0x7fffffffu / 3 - 1}) {
    const std::uint32_t in_key = trainer::cuda::face_of(trainer::cuda::visible_key(1.0f, face));
    const double ours = (device.name_of(face) != face) +
                        (texel.first_texel_of(face) != 3 * std::uint64_t(face)) + (in_key != face);
    const double naive = std::uint32_t(float(face)) != face;
    recorder.add({.at = double(face), .naive = naive, .ours = ours, .tolerance = 0});
    EXPECT_EQ(naive > 0, face > 1u << 24) << face;
  }
}

}  // namespace large_faces_test
}  // namespace tureen::test
