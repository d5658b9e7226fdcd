// For tests that run the program: a separate folder for each, kept if the test fails.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/output.hpp"
#include "image/png.hpp"
#include "tests/cli/child.hpp"

namespace tureen::test {

class Program : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder = std::filesystem::path(testing::TempDir()) /
             (std::string("tureen_") + info->test_suite_name() + "_" + info->name());
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
  }
  void TearDown() override {
    if (!HasFailure()) std::filesystem::remove_all(folder);
  }

  /// Images of an earlier call may be replaced: Outputs.OfRenderReplaceNothingWithoutForce tests
  /// that others are not.
  ChildResult run(std::vector<std::string> arguments) const {
    if (!arguments.empty() && arguments[0] == "render") arguments.emplace_back("--force");
    return run_tureen(arguments, folder);
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
  }
  void write_png(const std::string& name, const Image8& image) const {
    Output output(folder / name);
    output.write(encode_png(image));
    output.commit();
  }
  Image8 read_png(const std::string& name) const {
    Input input = Input::open(folder / name);
    return read_image(input);
  }
  /// Writes two coloured triangles, z up, and a third that repeats the first.
  void write_scene() const {
    write("scene.off",
          "COFF\n4 3 0\n-1 0 -1\n1 0 -1\n0 0 1\n0 1 0\n"
          "3 0 1 2 255 0 0\n3 0 1 3 0 255 0\n3 0 1 2 0 0 255\n");
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }
  std::vector<std::string> keys(const nlohmann::ordered_json& json) const {
    std::vector<std::string> result;
    for (const auto& [key, value] : json.items()) result.push_back(key);
    return result;
  }

  std::filesystem::path folder;
};

}  // namespace tureen::test
