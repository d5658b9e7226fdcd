// Written extensions against docs/TUREEN_triangle_soup.schema.json, by python3-jsonschema.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/formats/tureen_glb/tureen_glb_kinds.hpp"

namespace tureen::test {

/// What the schema describes: the name of a definition, or "" for the root, and a value.
using SchemaPairs = std::vector<std::pair<std::string, nlohmann::json>>;

/// Adds the extensions of a GLB: of its root, its layers and its splats.
inline void add_extensions(SchemaPairs& pairs, const nlohmann::json& glb) {
  const auto& root = glb["extensions"][tureen_extension];
  pairs.emplace_back("", root);
  for (const auto& node : root.value("layers", nlohmann::json::array()))
    if (const auto& layer = glb["nodes"][node.get<std::size_t>()]; layer.contains("extensions"))
      pairs.emplace_back("layer", layer["extensions"][tureen_extension]);
  for (const auto& mesh : glb.value("meshes", nlohmann::json::array()))
    for (const auto& primitive : mesh["primitives"]) {
      const nlohmann::json::json_pointer splats(
          "/extensions/KHR_gaussian_splatting/extensions/TUREEN_splats");
      if (primitive.contains(splats)) pairs.emplace_back("splats", primitive[splats]);
    }
}

/// The number of values that are invalid, at most 76, or 77 without python3-jsonschema. Prints what
/// is wrong.
inline int invalid_values(const SchemaPairs& pairs) {
  const auto path = temporary_glb("schema").replace_extension(".json");
  std::ofstream(path) << nlohmann::json(pairs).dump();
  const std::string folder = TUREEN_SOURCE_DIR;
  const int status =
      std::system(("'" + folder + "/tests/formats/tureen_glb/validate.py' '" + folder +
                   "/docs/TUREEN_triangle_soup.schema.json' <'" + path.string() + "'")
                      .c_str());
  std::filesystem::remove(path);
  return WEXITSTATUS(status) == 127 ? 77 : WEXITSTATUS(status);  // 127: there is no python3
}

}  // namespace tureen::test
