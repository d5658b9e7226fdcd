#include "formats/camera_json.hpp"

#include <cmath>
#include <glm/matrix.hpp>

#include "formats/png.hpp"
#include "soup/error.hpp"

namespace tureen {

using nlohmann::json;

namespace {

/// What keeps `matrix` from being a rotation, as the end of a sentence, or null.
const char* rotation_defect(const glm::dmat3& matrix) {
  const glm::dmat3 error = glm::transpose(matrix) * matrix - glm::dmat3(1.0);
  // Structure from motion prints six digits or more; a scale or a shear shows far above this.
  constexpr double tolerance = 1e-3;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (!(std::abs(error[c][r]) < tolerance))
        return "is no rotation: its axes are not of unit length or not square";
  return glm::determinant(matrix) < 0 ? "mirrors" : nullptr;
}

}  // namespace

CameraJson::CameraJson(Source source) : source_(std::move(source)) {
  if (!source_.object.is_object()) fail("it is no object");
}

void CameraJson::fail(const std::string& reason) const {
  throw InputError({source_.file, {}, {}}, source_.where + reason);
}

const json* CameraJson::find(const char* key) const {
  if (const auto found = source_.object.find(key); found != source_.object.end()) return &*found;
  if (!source_.common) return nullptr;
  const auto found = source_.common->find(key);
  return found != source_.common->end() ? &*found : nullptr;
}

std::optional<double> CameraJson::maybe_number(const char* key) const {
  const json* value = find(key);
  if (!value) return {};
  if (!value->is_number()) fail(std::string(key) + " is no number");
  return value->get<double>();
}

double CameraJson::number(const char* key) const {
  const std::optional<double> value = maybe_number(key);
  if (!value) fail(std::string(key) + " is missing");
  return *value;
}

std::optional<int> CameraJson::maybe_side(const char* key) const {
  const std::optional<double> value = maybe_number(key);
  if (!value) return {};
  if (!(*value >= 1 && *value <= max_image_side) || *value != std::floor(*value))
    fail(std::string(key) + " is no whole number from 1 to " + std::to_string(max_image_side));
  return int(*value);
}

int CameraJson::side(const char* key) const {
  const std::optional<int> value = maybe_side(key);
  if (!value) fail(std::string(key) + " is missing");
  return *value;
}

std::string CameraJson::text(const char* key) const {
  const json* value = find(key);
  return value && value->is_string() ? value->get<std::string>() : std::string();
}

bool CameraJson::truth(const char* key) const {
  const json* value = find(key);
  if (!value) return false;
  if (value->is_boolean()) return value->get<bool>();
  return value->is_number() && value->get<double>() != 0;
}

glm::dmat4 CameraJson::rigid(const char* key) const {
  const auto found = source_.object.find(key);
  if (found == source_.object.end() || !found->is_array()) fail(std::string(key) + " is no list");
  const json& rows = *found;
  if (rows.size() != 3 && rows.size() != 4) fail(std::string(key) + " has not 3 or 4 rows");
  glm::dmat4 result(1.0);
  for (int row = 0; row < 3; ++row) {
    if (!rows[std::size_t(row)].is_array() || rows[std::size_t(row)].size() != 4)
      fail(std::string(key) + " has a row that is not 4 numbers");
    for (int column = 0; column < 4; ++column) {
      const json& value = rows[std::size_t(row)][std::size_t(column)];
      if (!value.is_number()) fail(std::string(key) + " holds what is no number");
      result[column][row] = value.get<double>();
    }
  }
  if (const char* defect = rotation_defect(glm::dmat3(result)))
    fail(std::string(key) + " " + defect);
  return result;
}

const json& json_list(const json& root, const char* key, const std::string& file) {
  const auto found = root.find(key);
  if (found == root.end() || !found->is_array())
    throw InputError({file, {}, {}}, std::string(key) + " is no list");
  return *found;
}

}  // namespace tureen
