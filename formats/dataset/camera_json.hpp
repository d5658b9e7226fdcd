// What cameras in JSON have in common, whoever wrote them: numbers, sizes and poses, each checked,
// with failures that name the file and the camera. Include it in sources only.
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
    /// Where a number or a word is looked up that `object` lacks; may be null.
    const nlohmann::json* common = nullptr;
    std::string file;
    std::string where;  // within the file, for messages: "frame 3: "
  };

  /// Throws where `object` is none.
  explicit CameraJson(Source source);

  std::optional<double> maybe_number(const char* key) const;
  double number(const char* key) const;

  /// A width or height: a whole number from 1 to max_image_side, which may be written as 640.0.
  std::optional<int> maybe_side(const char* key) const;
  int side(const char* key) const;

  /// Empty where the key is missing or stands for something else than a text.
  std::string text(const char* key) const;
  /// Whether the key stands for true, or for a number other than 0.
  bool truth(const char* key) const;

  /// A rotation and a translation, from 3 or 4 rows of 4 numbers of `object` itself. Refused where
  /// the axes are not of unit length and square to three digits, or where they mirror.
  glm::dmat4 rigid(const char* key) const;
  /// A rotation from 3 rows of 3 numbers of `object` itself, refused like the above.
  glm::dmat3 rotation(const char* key) const;
  /// 3 numbers of `object` itself.
  glm::dvec3 vector(const char* key) const;

  [[noreturn]] void fail(const std::string& reason) const;

 private:
  const nlohmann::json* find(const char* key) const;
  const nlohmann::json& list(const char* key) const;
  double element(const char* key, const nlohmann::json& value) const;
  std::vector<glm::dvec4> rows(const char* key, int columns) const;

  Source source_;
};

/// The inverse of a pose whose axes, printed with six digits, are a little off: they are squared
/// up, so that the inverse is rigid to the last digit.
glm::dmat4 rigid_inverse(const glm::dmat4& pose);

/// Throws an InputError where `root` has no list under `key`.
const nlohmann::json& json_list(const nlohmann::json& root, const char* key,
                                const std::string& file);

}  // namespace tureen
