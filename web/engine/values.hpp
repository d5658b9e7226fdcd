// Conversions between the page's JSON and our types. They throw nlohmann::json's exceptions for
// missing values and wrong types. Only our own script sends this JSON, so the messages are for
// developers.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <initializer_list>
#include <nlohmann/json.hpp>

#include "camera/navigation.hpp"
#include "runtime/plan/plan.hpp"
#include "scene/camera.hpp"
#include "scene/similarity.hpp"

namespace tureen::web {

using Json = nlohmann::json;

/// A key and a value of object().
struct Member {
  const char* key;
  mutable Json value;  // moved from: initialiser lists are constant
};

/// A JSON object. The initialiser lists of nlohmann::json need several times the code.
Json object(std::initializer_list<Member> members);

Json to_json(const glm::dvec3& value);
glm::dvec3 vector_of(const Json& value);

/// 16 numbers, column by column.
Json to_json(const glm::dmat4& matrix);
glm::dmat4 matrix_of(const Json& value);

/// {"position", "rotation": radians, "scale", "mirror"}. placement_of throws UsageError for a scale
/// that is not above 0.
Json to_json(const Similarity& similarity);
Similarity placement_of(const Json& value);

Json to_json(const Camera& camera);
Camera camera_of(const Json& value);

Json to_json(const DeviceLimits& limits);
DeviceLimits limits_of(const Json& value);

/// "auto", "raster" or "tiles". blending_of throws UsageError for another name.
SplatBlending blending_of(const Json& name);

Json to_json(const Subject& subject);
Subject subject_of(const Json& value);

}  // namespace tureen::web
