#include "web/engine/values.hpp"

#include <glm/trigonometric.hpp>

#include "base/error.hpp"

namespace tureen::web {

Json object(std::initializer_list<Member> members) {
  Json result = Json::object();
  for (const Member& member : members) result[member.key] = std::move(member.value);
  return result;
}

Json to_json(const glm::dvec3& value) { return {value.x, value.y, value.z}; }

glm::dvec3 vector_of(const Json& value) {
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

Json to_json(const glm::dmat4& matrix) {
  Json numbers = Json::array();
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) numbers.push_back(matrix[column][row]);
  return numbers;
}

glm::dmat4 matrix_of(const Json& value) {
  glm::dmat4 matrix;
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = value.at(std::size_t(i)).get<double>();
  return matrix;
}

Json to_json(const Similarity& similarity) {
  return object({{"position", to_json(similarity.position)},
                 {"rotation", to_json(glm::radians(similarity.angles))},
                 {"scale", similarity.scale},
                 {"mirror", similarity.mirror}});
}

Similarity placement_of(const Json& value) {
  const Similarity result{.position = vector_of(value.at("position")),
                          .angles = glm::degrees(vector_of(value.at("rotation"))),
                          .scale = value.at("scale").get<double>(),
                          .mirror = value.at("mirror").get<bool>()};
  if (!(result.scale > 0)) throw UsageError("a placement needs a scale above 0");
  return result;
}

Json to_json(const Camera& camera) {
  return object({{"name", camera.name},
                 {"width", camera.width},
                 {"height", camera.height},
                 {"fx", camera.fx},
                 {"fy", camera.fy},
                 {"cx", camera.cx},
                 {"cy", camera.cy},
                 {"view_from_world", to_json(camera.view_from_world)}});
}

Camera camera_of(const Json& value) {
  Camera camera;
  camera.name = value.at("name").get<std::string>();
  camera.width = value.at("width").get<int>();
  camera.height = value.at("height").get<int>();
  camera.fx = value.at("fx").get<double>();
  camera.fy = value.at("fy").get<double>();
  camera.cx = value.at("cx").get<double>();
  camera.cy = value.at("cy").get<double>();
  camera.view_from_world = matrix_of(value.at("view_from_world"));
  return camera;
}

Json to_json(const DeviceLimits& limits) {
  return object({{"max_texture_size", limits.max_texture_size},
                 {"max_array_layers", limits.max_array_layers},
                 {"clip_control", limits.clip_control},
                 {"compute_shaders", limits.compute_shaders},
                 {"software", limits.software}});
}

DeviceLimits limits_of(const Json& value) {
  return {.max_texture_size = value.at("max_texture_size"),
          .max_array_layers = value.at("max_array_layers"),
          .clip_control = value.at("clip_control"),
          .compute_shaders = value.at("compute_shaders"),
          .software = value.at("software")};
}

SplatBlending blending_of(const Json& name) {
  for (std::size_t i = 0; i < splat_blending_names.size(); ++i)
    if (name == splat_blending_names[i]) return SplatBlending(i);
  throw UsageError("splats are blended by \"auto\", \"raster\" or \"tiles\", not " + name.dump());
}

Json to_json(const Subject& subject) {
  return object({{"low", to_json(subject.low)},
                 {"high", to_json(subject.high)},
                 {"up", to_json(subject.up)}});
}

Subject subject_of(const Json& value) {
  return {.low = vector_of(value.at("low")),
          .high = vector_of(value.at("high")),
          .up = vector_of(value.at("up"))};
}

}  // namespace tureen::web
