#include "formats/dataset/camera_json.hpp"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/error.hpp"
#include "image/png.hpp"

namespace tureen {

using nlohmann::json;

const char* rotation_defect(const glm::dmat3& matrix) {
  const glm::dmat3 error = glm::transpose(matrix) * matrix - glm::dmat3(1.0);
  // Structure from motion prints six digits or more; any real scale or shear exceeds this tolerance
  // by far.
  constexpr double tolerance = 1e-3;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (!(std::abs(error[c][r]) < tolerance))
        return "is not a rotation: its axes are not of unit length or not perpendicular";
  return glm::determinant(matrix) < 0 ? "mirrors" : nullptr;
}

CameraJson::CameraJson(Source source) : source_(std::move(source)) {
  if (!source_.object.is_object()) fail("it is not an object");
}

void CameraJson::fail(const std::string& reason) const {
  throw InputError({source_.file}, source_.where + reason);
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
  if (!value->is_number()) fail(std::string(key) + " is not a number");
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
    fail(std::string(key) + " is not an integer from 1 to " + std::to_string(max_image_side));
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

const json& CameraJson::list(const char* key) const {
  const auto found = source_.object.find(key);
  if (found == source_.object.end() || !found->is_array())
    fail(std::string(key) + " is not a list");
  return *found;
}

double CameraJson::element(const char* key, const json& value) const {
  if (!value.is_number()) fail(std::string(key) + " holds a value that is not a number");
  return value.get<double>();
}

/// All rows of a matrix; components after `columns` are 0.
std::vector<glm::dvec4> CameraJson::rows(const char* key, int columns) const {
  std::vector<glm::dvec4> result;
  for (const json& row : list(key)) {
    if (!row.is_array() || row.size() != std::size_t(columns))
      fail(std::string(key) + " has a row that is not " + std::to_string(columns) + " numbers");
    glm::dvec4& numbers = result.emplace_back(0.0);
    for (int column = 0; column < columns; ++column)
      numbers[column] = element(key, row[std::size_t(column)]);
  }
  return result;
}

glm::dmat4 CameraJson::affine(const char* key) const {
  if (const std::size_t count = list(key).size(); count != 3 && count != 4)
    fail(std::string(key) + " does not have 3 or 4 rows");
  glm::dmat4 transposed(1.0);
  const std::vector<glm::dvec4> found = rows(key, 4);
  if (found.size() == 4 && found[3] != glm::dvec4(0, 0, 0, 1))
    fail(std::string(key) + " has a last row other than 0 0 0 1");
  for (int row = 0; row < 3; ++row) transposed[row] = found[std::size_t(row)];
  return glm::transpose(transposed);
}

std::optional<glm::dmat4> CameraJson::maybe_affine(const char* key) const {
  if (!source_.object.contains(key)) return {};
  return affine(key);
}

glm::dmat4 CameraJson::rigid(const char* key) const {
  const glm::dmat4 result = affine(key);
  if (const char* defect = rotation_defect(glm::dmat3(result)))
    fail(std::string(key) + " " + defect);
  return result;
}

glm::dmat3 CameraJson::rotation(const char* key) const {
  if (list(key).size() != 3) fail(std::string(key) + " does not have 3 rows");
  const std::vector<glm::dvec4> found = rows(key, 3);
  const glm::dmat3 result =
      glm::transpose(glm::dmat3(glm::dvec3(found[0]), glm::dvec3(found[1]), glm::dvec3(found[2])));
  if (const char* defect = rotation_defect(result)) fail(std::string(key) + " " + defect);
  return result;
}

glm::dvec3 CameraJson::vector(const char* key) const {
  const json& numbers = list(key);
  if (numbers.size() != 3) fail(std::string(key) + " is not 3 numbers");
  glm::dvec3 result;
  for (int i = 0; i < 3; ++i) result[i] = element(key, numbers[std::size_t(i)]);
  return result;
}

glm::dmat4 rigid_inverse(const glm::dmat4& pose) {
  const glm::dvec3 backward = glm::normalize(glm::dvec3(pose[2]));
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(pose[1]), backward));
  const glm::dvec3 up = glm::cross(backward, right);
  const glm::dmat3 rotation = glm::transpose(glm::dmat3(right, up, backward));
  glm::dmat4 inverse(rotation);
  inverse[3] = glm::dvec4(-(rotation * glm::dvec3(pose[3])), 1.0);
  return inverse;
}

const json& json_list(const json& root, const char* key, const std::string& file) {
  const auto found = root.find(key);
  if (found == root.end() || !found->is_array())
    throw InputError({file}, std::string(key) + " is not a list");
  return *found;
}

}  // namespace tureen
