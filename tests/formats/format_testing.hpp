// Helpers of the format tests: texts as inputs, temporary folders, and matchers for errors.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/input.hpp"
#include "scene/scene.hpp"
#include "tests/support/errors.hpp"

namespace tureen::test {

using test::error_of;
using test::ErrorAt;
using test::ErrorIn;
using test::Names;
using test::Refusal;

/// `text` must outlive the Input.
inline Input input_of(const std::string& text, const std::string& name = "test.file") {
  return Input::memory(name, std::as_bytes(std::span(text)));
}

/// A new, empty folder. The destructor removes it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(TUREEN_BINARY_DIR) / "tests_tmp" /
            (std::string(test->test_suite_name()) + "." + test->name());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline const std::vector<glm::vec4>& face_rgba(const Scene& scene) {
  return std::get<FaceColors>(only_soup(scene).appearance).rgba;
}
inline const std::vector<glm::vec4>& vertex_rgba(const Scene& scene) {
  return std::get<VertexColors>(only_soup(scene).appearance).rgba;
}

}  // namespace tureen::test
