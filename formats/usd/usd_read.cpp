#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <map>
#include <string_view>
#include <utility>

#include "base/little_endian.hpp"
#include "formats/archive/zip_archive.hpp"
#include "formats/splat/splat_builder.hpp"
#include "formats/usd/usd.hpp"
#include "formats/usd/usd_text.hpp"
#include "scene/spherical_harmonics.hpp"

namespace tureen {

namespace {

constexpr std::string_view usda_magic = "#usda", usdc_magic = "PXR-USDC";
constexpr int max_prim_depth = 64;
/// Of a prim: its children multiply them, so many would take time in the square of the file.
constexpr std::size_t max_transforms = 64;

/// What the reader knows of a prim.
struct UsdPrim {
  std::string type, name;
  bool is_surflet = false, is_constant = false, is_visible = true;
  glm::dmat4 world{1.0};
  std::map<std::string, glm::dmat4, std::less<>> steps;  // of the transform, by name
  std::vector<std::string> order;
  std::vector<float> positions, orientations, scales, opacities, coefficients;
  int degree = 0;

  bool is_field() const {
    return type == "ParticleField" || type == "ParticleField3DGaussianSplat";
  }
};

class UsdReader {
 public:
  /// `text` outlives the reader.
  UsdReader(Input& input, std::string_view text, const std::string& file,
            const ReadOptions& options)
      : input_(input), text_(text, file, input.budget()), options_(options) {}

  Scene read() {
    if (text_.take('(')) read_layer_metadata();
    while (text_.next()) read_statement(glm::dmat4(1), 0, nullptr);
    if (scenes_.empty())
      text_.fail("there is no field of particles",
                 "supported are ParticleField3DGaussianSplat, and ParticleField with surflets");
    std::string name = std::move(scenes_.front().info.name);
    Scene scene = merged(std::move(scenes_));
    scene.info.name = std::move(name);
    scene.info.source = "USD";
    choose_up(scene.info, up_);
    scene.info.up_is_assumed = false;
    return scene;
  }

 private:
  void read_layer_metadata() {
    while (!text_.take(')')) {
      if (!text_.next()) text_.fail("the file ends within its metadata");
      const std::string_view key = text_.word();
      if (key.empty()) {
        text_.skip_value();
      } else if (text_.take('=')) {
        const std::string_view value = text_.value_text();
        if (key == "upAxis") up_ = value == "\"Z\"" ? glm::vec3(0, 0, 1) : glm::vec3(0, 1, 0);
      }
    }
  }

  /// A prim, or a property of `prim`. `parent`: the place of its parent, or of `prim`'s parent.
  void read_statement(const glm::dmat4& parent, int depth, UsdPrim* prim) {
    const std::string_view first = text_.word();
    if (first == "def" || first == "over" || first == "class") {
      const bool outside = std::exchange(is_class_, is_class_ || first == "class");
      read_prim(prim ? parent * local(*prim) : parent, depth);
      is_class_ = outside;
      return;
    }
    if (first == "variantSet") {
      text_.next();
      text_.quoted();
      text_.expect('=');
      return text_.skip_value();
    }
    if (first.empty() || !prim) text_.fail("expected a prim");
    // Words up to = or the end of the line: qualifiers, type and name.
    std::string_view name = first;
    while (text_.next_on_line() && text_.peek() != '=' && text_.peek() != '(') {
      name = text_.word();
      if (name.empty()) text_.fail("expected a property");
    }
    if (text_.peek() == '=') {
      text_.expect('=');
      read_value(name, *prim);
      if (text_.next_on_line() && text_.peek() == '(') text_.skip_value();
    } else if (text_.peek() == '(') {
      text_.skip_value();
    }
    if (text_.next_on_line() && text_.peek() == ';') text_.take(';');
  }

  void read_prim(const glm::dmat4& parent, int depth) {
    if (depth == max_prim_depth) text_.fail("prims nest more than 64 levels");
    UsdPrim prim;
    text_.next();
    if (text_.peek() != '"') {
      prim.type = text_.word();
      text_.next();
    }
    prim.name = text_.quoted();
    text_.next();
    if (text_.peek() == '(') {
      const std::string_view metadata = text_.value_text();
      prim.is_surflet = metadata.find("KernelGaussianSurfletAPI") != metadata.npos;
      prim.is_constant = metadata.find("KernelConstantSurfletAPI") != metadata.npos;
    }
    text_.expect('{');
    path_.push_back(&prim);
    // Children need the prim's place, which its properties give; they come first in practice.
    while (!text_.take('}')) {
      if (!text_.next()) text_.fail("the file ends within the prim \"" + prim.name + "\"");
      read_statement(parent, depth + 1, &prim);
    }
    prim.world = parent * local(prim);
    if (prim.is_field() && !is_class_) add_field(prim);
    path_.pop_back();
  }

  void read_value(std::string_view name, UsdPrim& prim) {
    const auto is = [&](std::string_view attribute) {
      return name == attribute || (name.size() == attribute.size() + 1 && name.back() == 'h' &&
                                   name.starts_with(attribute));
    };
    text_.next();
    const bool has_values = text_.peek() == '[';
    if (prim.is_field() && has_values) {
      if (is("positions")) return void(prim.positions = text_.floats());
      if (is("orientations")) return void(prim.orientations = text_.floats());
      if (is("scales")) return void(prim.scales = text_.floats());
      if (is("opacities")) return void(prim.opacities = text_.floats());
      if (is("radiance:sphericalHarmonicsCoefficients"))
        return void(prim.coefficients = text_.floats());
    }
    if (name == "radiance:sphericalHarmonicsDegree") {
      const std::vector<double> values = text_.numbers();
      if (values.size() != 1 || !(values[0] >= 0 && values[0] <= harmonics::max_degree) ||
          values[0] != std::floor(values[0]))
        text_.fail("the degree of harmonics is not 0 to 4");
      prim.degree = int(values[0]);
    } else if (name == "visibility") {
      prim.is_visible = text_.value_text() != "\"invisible\"";
    } else if (name == "xformOpOrder") {
      read_order(text_.value_text(), prim);
    } else if (name.starts_with("xformOp:") && name.find(".timeSamples") == name.npos) {
      read_transform(name, prim);
    } else {
      text_.skip_value();
    }
  }

  void read_order(std::string_view value, UsdPrim& prim) const {
    prim.order.clear();
    for (std::size_t at = value.find('"'); at != value.npos;) {
      const std::size_t end = value.find('"', at + 1);
      if (end == value.npos) break;
      if (prim.order.size() == max_transforms)
        text_.fail("a prim has more than " + std::to_string(max_transforms) + " transforms");
      prim.order.emplace_back(value.substr(at + 1, end - at - 1));
      at = value.find('"', end + 1);
    }
  }

  void read_transform(std::string_view name, UsdPrim& prim) {
    const std::string_view kind = name.substr(8, name.find(':', 8) - 8);
    const bool is_known = kind == "transform" || kind == "translate" || kind == "scale" ||
                          kind == "orient" || kind == "rotateXYZ";
    if (!is_known) return text_.skip_value();  // an error if it is in the order
    const std::vector<double> v = text_.numbers();
    if (v.size() != (kind == "transform" ? 16 : kind == "orient" ? 4 : 3))
      text_.fail(std::string(name) + " has " + std::to_string(v.size()) + " numbers");
    glm::dmat4 step(1);
    const auto turn = [](double degrees, const glm::dvec3& axis) {
      return glm::rotate(glm::dmat4(1), glm::radians(degrees), axis);
    };
    if (kind == "transform")
      for (int i = 0; i < 16; ++i) step[i / 4][i % 4] = v[std::size_t(i)];
    else if (kind == "translate")
      step = glm::translate(step, glm::dvec3(v[0], v[1], v[2]));
    else if (kind == "scale")
      step = glm::scale(step, glm::dvec3(v[0], v[1], v[2]));
    else if (kind == "orient")
      step = glm::mat4_cast(glm::normalize(glm::dquat(v[0], v[1], v[2], v[3])));
    else  // about x first
      step = turn(v[2], {0, 0, 1}) * turn(v[1], {0, 1, 0}) * turn(v[0], {1, 0, 0});
    prim.steps[std::string(name)] = step;
  }

  glm::dmat4 local(const UsdPrim& prim) const {
    glm::dmat4 matrix(1);
    for (const std::string& name : prim.order) {
      const auto step = prim.steps.find(name);
      if (step != prim.steps.end()) matrix *= step->second;  // the order may stand before it
    }
    return matrix;
  }

  void add_field(const UsdPrim& prim) {
    for (const UsdPrim* each : path_)
      for (const std::string& name : each->order)
        if (!each->steps.contains(name))
          text_.fail("the transform " + name + " of the prim \"" + each->name +
                     "\" is not supported or has no value");
    if (prim.is_constant) text_.fail("constant surflets are not supported");
    const std::size_t count = prim.positions.size() / 3;
    const std::size_t each = std::size_t(harmonics::count(prim.degree));
    const auto require = [&](const std::vector<float>& values, std::size_t columns,
                             const char* what) {
      if (values.size() != count * columns)
        text_.fail("the prim \"" + prim.name + "\" has " + std::to_string(count) +
                   " positions, but " + std::to_string(values.size()) + " numbers of " + what);
    };
    require(prim.positions, 3, "positions");
    require(prim.orientations, 4, "orientations");
    require(prim.scales, 3, "scales");
    if (!prim.opacities.empty()) require(prim.opacities, 1, "opacities");
    require(prim.coefficients, 3 * each, "harmonics");
    SplatBuilder builder(input_, options_, Gaussians{.flat = prim.is_surflet}, prim.degree, count);
    std::array<glm::vec3, harmonics::count(harmonics::max_degree)> coefficients;
    for (std::size_t i = 0; i < count; ++i) {
      const auto row = [&](const std::vector<float>& values) {
        return glm::dvec3(double(values[3 * i]), double(values[3 * i + 1]),
                          double(values[3 * i + 2]));
      };
      const float* q = &prim.orientations[4 * i];
      for (std::size_t k = 0; k < each; ++k) {
        const float* rgb = &prim.coefficients[3 * (i * each + k)];
        coefficients[k] = glm::vec3(rgb[0], rgb[1], rgb[2]);
      }
      SplatValues splat{
          .center = row(prim.positions),
          .scales = row(prim.scales),
          .rotation = glm::dquat(double(q[0]), double(q[1]), double(q[2]), double(q[3])),
          .opacity = prim.opacities.empty() ? 1.0 : double(prim.opacities[i])};
      builder.add(splat, std::span(coefficients).first(each));
    }
    Scene scene = builder.finish(*profile_named(prim.is_surflet ? "2dgs" : "3dgs"), "USD");
    Layer& layer = scene.layers.front();
    layer.name = prim.name;
    layer.world_from_layer = prim.world * layer.world_from_layer;
    layer.visible = std::all_of(path_.begin(), path_.end(),
                                [](const UsdPrim* above) { return above->is_visible; });
    if (const auto reason = defect(layer)) text_.fail(*reason);
    scenes_.push_back(std::move(scene));
  }

  Input& input_;
  UsdText text_;
  const ReadOptions& options_;
  glm::vec3 up_{0, 1, 0};             // USD's default
  std::vector<const UsdPrim*> path_;  // from the root to the prim that is being read
  bool is_class_ = false;             // it only describes prims, and none of its fields is drawn
  std::vector<Scene> scenes_;
};

Scene read_usd_bytes(Input& input, std::vector<std::byte> bytes, const std::string& file,
                     const ReadOptions& options) {
  const std::size_t size = bytes.size();
  bytes.push_back(std::byte{0});  // ends a number at the end of the text
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), size);
  if (text.starts_with(usdc_magic))
    throw InputError({file}, "binary USD is not supported",
                     "usdcat scene.usdc -o scene.usda converts it to text");
  if (!text.starts_with(usda_magic))
    throw InputError({file}, "not a USD file: it does not begin with #usda");
  return UsdReader(input, text, file, options).read();
}

}  // namespace

bool is_usd(std::span<const std::byte> head) {
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  if (text.starts_with("PK\3\4") && head.size() > 30) {
    const std::string_view first = text.substr(30, std::size_t(little_number(head, 26, 2)));
    return first.ends_with(".usda") || first.ends_with(".usdc") || first.ends_with(".usd");
  }
  return text.starts_with(usda_magic) || text.starts_with(usdc_magic);
}

Scene read_usd(Input input, const ReadOptions& options) {
  std::array<std::byte, 2> start{};
  if (input.read_some(start) == 2 && start[0] == std::byte('P') && start[1] == std::byte('K')) {
    const std::string name = input.name();
    ZipArchive archive(std::move(input));
    if (archive.entries().empty()) throw InputError({name}, "the archive is empty");
    // The first file of the archive is the scene.
    const ZipEntry& first =
        *std::min_element(archive.entries().begin(), archive.entries().end(),
                          [](const ZipEntry& a, const ZipEntry& b) { return a.header < b.header; });
    return read_usd_bytes(archive.input(), archive.read_all(first, ZipArchive::max_inflated_bytes),
                          name + "/" + first.name, options);
  }
  input.seek(0);
  std::vector<std::byte> bytes = input.read_rest();
  return read_usd_bytes(input, std::move(bytes), input.name(), options);
}

Scene read_usd(const std::filesystem::path& path, const ReadOptions& options) {
  return read_usd(Input::open(path), options);
}

}  // namespace tureen
