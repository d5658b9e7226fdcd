// The program prints texts from files so that they cannot be mistaken for its own output.
#include <gmock/gmock.h>

#include <sstream>

#include "tests/cli/program_fixture.hpp"

namespace tureen {
namespace untrusted_text_program_test {

using test::ChildResult;
using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class UntrustedText : public test::Program {
 protected:
  /// Writes one triangle with this generator name.
  void write_gltf(const std::string& generator) const {
    const nlohmann::json gltf{
        {"asset", {{"version", "2.0"}, {"generator", generator}}},
        {"scene", 0},
        {"scenes", {{{"nodes", {0}}}}},
        {"nodes", {{{"mesh", 0}}}},
        {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
        {"buffers",
         {{{"byteLength", 36},
           {"uri",
            "data:application/octet-stream;base64,"
            "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}}},
        {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
        {"accessors",
         {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}}};
    write("scene.gltf", gltf.dump());
  }
  static std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> result;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) result.push_back(line);
    return result;
  }
};

TEST_F(UntrustedText, BeginsNoLineAndSteersNoTerminal) {
  // U+FFFF at the end is valid in JSON, but it is not a character.
  const std::string generator =
      "x\n  triangles    9 of 9 vertices\r\x1b[2J\xc2\x9b\x7f\xef\xbf\xbf";
  write_gltf(generator);
  const ChildResult result = run({"info", "scene.gltf", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(lines(result.err), Each(Not(StartsWith("  triangles    9"))));
  EXPECT_THAT(
      lines(result.err)[0],
      HasSubstr("glTF by x\\n  triangles    9 of 9 vertices\\r\\u001b[2J\\u009b\\u007f\\uffff"));
  for (const char* steering : {"\r", "\x1b", "\xc2\x9b", "\x7f"}) {
    EXPECT_THAT(result.err, Not(HasSubstr(steering)));
    EXPECT_THAT(result.out, Not(HasSubstr(steering)));
  }
  // The JSON output contains the text unchanged.
  EXPECT_EQ(nlohmann::json::parse(result.out)["source"], "glTF by " + generator);
}

TEST_F(UntrustedText, DoesNotFillTheScreen) {
  write_gltf(std::string(1'000'000, 'x'));
  const ChildResult result = run({"info", "scene.gltf"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_LT(result.err.size(), 5000u);
}

TEST_F(UntrustedText, OfArgumentsIsShownAlike) {
  const ChildResult result = run({"info", "a\nb\x1b[2J.glb"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, StartsWith("tureen: a\\nb\\u001b[2J.glb: "));
}

}  // namespace untrusted_text_program_test
}  // namespace tureen
