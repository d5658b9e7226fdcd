#include <algorithm>
#include <array>
#include <charconv>
#include <glm/mat4x4.hpp>
#include <set>
#include <utility>

#include "base/decimal.hpp"
#include "base/error.hpp"
#include "base/extension.hpp"
#include "base/output.hpp"
#include "formats/archive/zip_writer.hpp"
#include "formats/splat/splat_writing.hpp"
#include "formats/usd/usd.hpp"
#include "scene/similarity.hpp"

namespace tureen {

namespace {

constexpr std::size_t usdz_alignment = 64;

/// A name of a prim: letters, digits and underscores, unlike the others.
std::string prim_name(const std::string& label, std::set<std::string>& taken) {
  std::string name;
  for (const char c : label) {
    const bool is_fit = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    name += is_fit ? c : '_';
  }
  if (name.empty() || (name[0] >= '0' && name[0] <= '9')) name = "_" + name;
  std::string unique = name;
  for (int k = 2; !taken.insert(unique).second; ++k) unique = name + "_" + std::to_string(k);
  return unique;
}

/// "[(1, 2, 3), (4, 5, 6)]", or without parentheses for rows of one value.
template <class Value>
void append_rows(std::string& text, std::size_t rows, std::size_t columns, Value&& value) {
  std::array<char, max_float_text> number;
  text += '[';
  for (std::size_t i = 0; i < rows; ++i) {
    if (i > 0) text += ", ";
    if (columns > 1) text += '(';
    for (std::size_t k = 0; k < columns; ++k) {
      if (k > 0) text += ", ";
      text.append(number.data(), format_float(number.data(), value(i, k)));
    }
    if (columns > 1) text += ')';
  }
  text += "]\n";
}

/// The shortest text that reads back as this number.
std::string exact_text(double value) {
  std::array<char, 32> text;
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

/// USD multiplies rows by matrices: its rows are our columns.
std::string matrix_text(const glm::dmat4& matrix) {
  std::string text = "(";
  for (int c = 0; c < 4; ++c) {
    text += c > 0 ? ", (" : "(";
    for (int r = 0; r < 4; ++r) text += (r > 0 ? ", " : "") + exact_text(matrix[c][r]);
    text += ")";
  }
  return text + ")";
}

std::string transform_text(const glm::dmat4& matrix, const std::string& indent) {
  return indent + "matrix4d xformOp:transform = " + matrix_text(matrix) + "\n" + indent +
         "uniform token[] xformOpOrder = [\"xformOp:transform\"]\n";
}

std::string layer_text(const Layer& layer, const std::string& name) {
  const auto& splats = std::get<Splats>(layer.primitives);
  const auto& gaussians = std::get<Gaussians>(splats.kernel);
  const std::size_t count = gaussians.centers.size();
  std::string text = "\n    def ";
  if (gaussians.flat) {
    text += "ParticleField \"" + name + "\" (\n        prepend apiSchemas = [";
    for (const char* part : {"PositionAttribute", "OrientationAttribute", "ScaleAttribute",
                             "OpacityAttribute", "KernelGaussianSurflet"})
      text += "\"ParticleField" + std::string(part) + "API\", ";
    text += "\"ParticleFieldSphericalHarmonicsAttributeAPI\"]\n    )\n";
  } else {
    text += "ParticleField3DGaussianSplat \"" + name + "\"\n";
  }
  text += "    {\n";
  if (!layer.visible) text += "        token visibility = \"invisible\"\n";
  text += transform_text(layer.world_from_layer, "        ");
  text += "        point3f[] positions = ";
  append_rows(text, count, 3, [&](auto i, auto k) { return gaussians.centers[i][int(k)]; });
  text += "        quatf[] orientations = ";
  append_rows(text, count, 4, [&](auto i, auto k) {
    const glm::quat& q = gaussians.rotations[i];
    return std::array<float, 4>{q.w, q.x, q.y, q.z}[k];
  });
  text += "        float3[] scales = ";
  append_rows(text, count, 3, [&](auto i, auto k) {
    return gaussians.flat && k == 2 ? 0 : gaussians.scales[i][int(k)];
  });
  text += "        float[] opacities = ";
  append_rows(text, count, 1, [&](auto i, auto) { return gaussians.opacity[i]; });
  text += "        uniform int radiance:sphericalHarmonicsDegree = " +
          std::to_string(splats.color.degree) + "\n";
  text += "        float3[] radiance:sphericalHarmonicsCoefficients = ";
  append_rows(text, splats.color.coefficients.size(), 3,
              [&](auto i, auto k) { return splats.color.coefficients[i][int(k)]; });
  if (!gaussians.flat)
    text +=
        "        uniform token projectionModeHint = \"perspective\"\n"
        "        uniform token sortingModeHint = \"zDepth\"\n";
  return text + "    }\n";
}

std::vector<std::string> usd_losses(const Scene& scene) {
  std::vector<std::string> lost;
  for (const Layer& layer : scene.layers) {
    const auto& splats = std::get<Splats>(layer.primitives);
    const bool flat = std::get<Gaussians>(splats.kernel).flat;
    const std::string stored = flat ? "2dgs" : "3dgs";
    for (const std::string& each : profile_losses(splats.profile, "USD", stored))
      lost.push_back(each);
  }
  std::sort(lost.begin(), lost.end());
  lost.erase(std::unique(lost.begin(), lost.end()), lost.end());
  if (scene.info.background != glm::vec3(0.0f)) lost.push_back("USD holds no background colour.");
  if (!scene.cameras.empty()) lost.push_back("Cameras are not written to USD.");
  if (scene.first_view) lost.push_back("USD holds no first view.");
  return lost;
}

}  // namespace

std::vector<std::string> write_usd(const Scene& scene, const std::filesystem::path& path) {
  for (const Layer& layer : scene.layers) {
    const auto* splats = std::get_if<Splats>(&layer.primitives);
    if (!splats || !std::holds_alternative<Gaussians>(splats->kernel))
      throw UsageError(std::string("USD is written only for Gaussians, and this scene has ") +
                           (splats ? kernel_name(splats->kernel) : "triangles"),
                       "write .glb");
  }
  const bool is_z_up = scene.info.up == glm::vec3(0, 0, 1);
  std::string text =
      std::string("#usda 1.0\n(\n    defaultPrim = \"World\"\n    metersPerUnit = 1\n") +
      "    upAxis = \"" + (is_z_up ? "Z" : "Y") + "\"\n)\n\ndef Xform \"World\"\n{\n";
  if (!is_z_up)
    text += transform_text(
        glm::dmat4(rotation_between(glm::dvec3(scene.info.up), glm::dvec3(0, 1, 0))), "    ");
  Output output(path);
  const bool is_archive = extension_of(path) == ".usdz";
  std::set<std::string> names;
  for (std::size_t i = 0; i < scene.layers.size(); ++i) {
    text += layer_text(scene.layers[i], prim_name(label(scene.layers[i], i), names));
    if (!is_archive) {
      output.write(std::string_view(text));
      text.clear();
    }
  }
  text += "}\n";
  if (is_archive) {
    ZipWriter zip(output, usdz_alignment);
    zip.add("scene.usda", std::as_bytes(std::span(text)));
    zip.finish();
  } else {
    output.write(std::string_view(text));
  }
  output.commit();
  return usd_losses(scene);
}

}  // namespace tureen
