// Evaluates a formula of shaders/ on the device, one input a pixel, and reads back the results.
#pragma once

#include <glm/vec4.hpp>
#include <map>
#include <string>
#include <vector>

#include "runtime/gl/api.hpp"
#include "runtime/gl/program.hpp"
#include "runtime/passes/shader_source.hpp"
#include "runtime/passes/targets.hpp"

namespace tureen::test {

/// Evaluates `vec4 probe(vec4 input)`, which the shader text must define.
class Probe {
 public:
  Probe(gl::Api api, const std::string& text, const std::map<std::string, std::string>& constants,
        std::map<std::string, std::string> generated = {})
      : program_(assemble({.file = "full_screen.vert"}, api),
                 assemble({.file = "probe",
                           .constants = constants,
                           .generated = with(std::move(generated), text + main_text)},
                          api)) {}

  /// The program, in use, so that the caller can set uniforms of the text.
  const gl::Program& program() const {
    program_.use();
    return program_;
  }

  /// Uses texture unit 0 for the inputs; the other units stay unchanged.
  std::vector<glm::vec4> run(const std::vector<glm::vec4>& inputs) const {
    const int count = static_cast<int>(inputs.size());
    glActiveTexture(GL_TEXTURE0);
    gl::Texture source = make_target(rgba32f, count, 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, count, 1, GL_RGBA, GL_FLOAT, inputs.data());
    const gl::Texture target = make_target(rgba32f, count, 1);
    const gl::Framebuffer framebuffer = make_framebuffer({target.id()});
    const gl::VertexArray nothing = gl::VertexArray::create();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    glViewport(0, 0, count, 1);
    glDisable(GL_DEPTH_TEST);
    program_.use();
    glBindTexture(GL_TEXTURE_2D, source.id());
    program_.set("inputs", 0);
    program_.set("background_depth", 0.0f);
    glBindVertexArray(nothing.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    std::vector<glm::vec4> results(inputs.size());
    glReadPixels(0, 0, count, 1, GL_RGBA, GL_FLOAT, results.data());
    return results;
  }

 private:
  static constexpr TargetFormat rgba32f{GL_RGBA32F, GL_RGBA, GL_FLOAT, 16};
  static constexpr const char* main_text =
      "\nuniform sampler2D inputs;\n"
      "layout(location = 0) out vec4 result;\n"
      "void main() { result = probe(texelFetch(inputs, ivec2(int(gl_FragCoord.x), 0), 0)); }\n";

  static std::map<std::string, std::string> with(std::map<std::string, std::string> generated,
                                                 std::string text) {
    generated["probe"] = std::move(text);
    return generated;
  }

  gl::Program program_;
};

}  // namespace tureen::test
