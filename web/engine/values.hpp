// Conversions between the page's JSON and our types. They throw nlohmann::json's exceptions for
// missing values and wrong types. Only our own script sends this JSON, so the messages are for
// developers.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include "camera/navigation.hpp"
#include "runtime/plan/plan.hpp"
#include "scene/camera.hpp"
#include "scene/similarity.hpp"

namespace tureen::web {

using Json = nlohmann::json;

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
