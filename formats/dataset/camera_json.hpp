// Code shared by all readers of cameras in JSON: checked numbers, sizes and poses. Errors name the
// file and the camera. Include it only in sources.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace tureen {

/// The fields of one camera. The JSON must outlive it.
class CameraJson {
 public:
  struct Source {
    const nlohmann::json& object;
    /// Fallback for numbers and words that `object` lacks; may be null.
    const nlohmann::json* common = nullptr;
    std::string file;
    std::string where;  // in the file, for messages: "frame 3: "
  };

  /// Throws if `object` is not an object.
  explicit CameraJson(Source source);

  std::optional<double> maybe_number(const char* key) const;
  double number(const char* key) const;

  /// A width or height: an integer from 1 to max_image_side; 640.0 is accepted.
  std::optional<int> maybe_side(const char* key) const;
  int side(const char* key) const;

  /// Empty if the key is missing or its value is not a text.
  std::string text(const char* key) const;
  /// Whether the value is true or a number other than 0.
  bool truth(const char* key) const;

  /// An affine map from 3 or 4 rows of 4 numbers in `object` itself, or nullopt without the key.
  std::optional<glm::dmat4> maybe_affine(const char* key) const;
  /// A rotation and a translation, from 3 or 4 rows of 4 numbers in `object` itself. Throws if the
  /// axes are not orthonormal to three digits, or if they mirror.
  glm::dmat4 rigid(const char* key) const;
  /// A rotation from 3 rows of 3 numbers in `object` itself, checked like the above.
  glm::dmat3 rotation(const char* key) const;
  /// 3 numbers in `object` itself.
  glm::dvec3 vector(const char* key) const;

  [[noreturn]] void fail(const std::string& reason) const;

 private:
  const nlohmann::json* find(const char* key) const;
  const nlohmann::json& list(const char* key) const;
  glm::dmat4 affine(const char* key) const;
  double element(const char* key, const nlohmann::json& value) const;
  std::vector<glm::dvec4> rows(const char* key, int columns) const;

  Source source_;
};

/// The reason why `matrix` is not a rotation to three digits, as the end of a sentence, or null.
const char* rotation_defect(const glm::dmat3& matrix);

/// The inverse of a pose. Axes printed with six digits are slightly off, so they are
/// orthonormalised first; the inverse is exactly rigid.
glm::dmat4 rigid_inverse(const glm::dmat4& pose);

/// Throws InputError if `root` has no list under `key`.
const nlohmann::json& json_list(const nlohmann::json& root, const char* key,
                                const std::string& file);

}  // namespace tureen
