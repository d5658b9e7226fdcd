#include "trainer/diffsoup/checkpoint.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/type_ptr.hpp>

#include "base/existing_path.hpp"
#include "base/output.hpp"
#include "scene/lattice.hpp"
#include "trainer/diffsoup/config_fields.hpp"
#include "trainer/diffsoup/config_file.hpp"
#include "trainer/diffsoup/levels.hpp"

namespace tureen::trainer {

namespace {

using Magic = std::array<char, 8>;
constexpr Magic magic{'T', 'U', 'R', 'E', 'E', 'N', 'T', 'R'};

/// Maximum side of an image, as in our own files.
constexpr std::int32_t max_side = 65'536;

std::uint32_t checksum(std::uint32_t sum, std::span<const std::byte> bytes) {
  if (bytes.empty()) return sum;  // for a null pointer zlib returns the initial sum
  return std::uint32_t(crc32_z(sum, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

class Writer {
 public:
  explicit Writer(Output& output) : output_(output) {}

  template <class T>
  void operator()(const T& value, const char*) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(std::as_bytes(std::span(&value, 1)));
  }
  template <class T>
  void operator()(const std::vector<T>& values, const char* what) {
    (*this)(std::uint64_t(values.size()), what);
    bytes(std::as_bytes(std::span(values)));
  }
  void operator()(const std::string& text, const char* what) {
    (*this)(std::uint64_t(text.size()), what);
    bytes(std::as_bytes(std::span(text)));
  }
  std::uint32_t sum() const { return sum_; }

 private:
  void bytes(std::span<const std::byte> bytes) {
    sum_ = checksum(sum_, bytes);
    output_.write(bytes);
  }

  Output& output_;
  std::uint32_t sum_ = 0;
};

class Reader {
 public:
  explicit Reader(Input& input) : input_(input) {}

  template <class T>
  void operator()(T& value, const char* what) {
    static_assert(std::is_trivially_copyable_v<T>);
    value = input_.read_value<T>(what);
    sum_ = checksum(sum_, std::as_bytes(std::span(&value, 1)));
  }
  template <class T>
  void operator()(std::vector<T>& values, const char* what) {
    values = input_.read_values<T>(count(what), what);
    sum_ = checksum(sum_, std::as_bytes(std::span(values)));
  }
  void operator()(std::string& text, const char* what) {
    const std::vector<char> letters = input_.read_values<char>(count(what), what);
    sum_ = checksum(sum_, std::as_bytes(std::span(letters)));
    text.assign(letters.begin(), letters.end());
  }
  std::uint32_t sum() const { return sum_; }

 private:
  std::uint64_t count(const char* what) {
    std::uint64_t value = 0;
    (*this)(value, what);
    return value;
  }

  Input& input_;
  std::uint32_t sum_ = 0;
};

template <class Archive, class View>
void visit_view(Archive& archive, View& view) {
  auto& [name, width, height, camera, pixels] = view;
  archive(name, "the name of a view");
  archive(width, "the width of a view");
  archive(height, "the height of a view");
  archive(camera, "the checksum of a camera");
  archive(pixels, "the checksum of a photograph");
}

/// Visits every member of a state, in the order of the file. A new member of the structs causes a
/// compile error until it is added here.
template <class Archive, class State>
void visit_state(Archive& archive, State& state) {
  auto& [model, moments, step, errors, baseline, non_finite] = state;
  archive(step, "the step");
  archive(errors, "the errors of the faces");
  archive(baseline, "the baseline");
  archive(non_finite, "the count of quarantined numbers");
  auto& [min_level, max_level, positions, logits, mlp, origin] = model;
  archive(min_level, "the lowest level");
  archive(max_level, "the highest level");
  archive(positions, "the positions");
  archive(logits, "the texels");
  archive(mlp, "the color MLP");
  archive(origin, "the origin");
  auto& [first, second, vertex_first, vertex_second, steps, mlp_first, mlp_second, mlp_steps] =
      moments;
  archive(first, "the first moments of the texels");
  archive(second, "the second moments of the texels");
  archive(vertex_first, "the first moments of the positions");
  archive(vertex_second, "the second moments of the positions");
  archive(steps, "the steps of the faces");
  archive(mlp_first, "the first moments of the color MLP");
  archive(mlp_second, "the second moments of the color MLP");
  archive(mlp_steps, "the steps of the color MLP");
}

template <class Values>
bool all_finite(const Values& values) {
  for (const float value : values)
    if (!std::isfinite(value)) return false;
  return true;
}

std::optional<std::string> defect(const Model& model) {
  if (model.min_level < 0 || model.max_level > lattice::max_level ||
      model.min_level > model.max_level)
    return fmt::format("levels {} to {} are invalid", model.min_level, model.max_level);
  if (model.positions.size() % 3 != 0)
    return fmt::format("{} positions are not a multiple of three", model.positions.size());
  if (model.logits.size() != model.faces() * model.texels() * channels)
    return fmt::format("{} faces cannot have {} texel values", model.faces(), model.logits.size());
  bool finite = all_finite(model.logits) && all_finite(model.mlp);
  for (const glm::vec3& position : model.positions)
    finite = finite && all_finite(std::span(glm::value_ptr(position), 3));
  for (int axis = 0; axis < 3; ++axis) finite = finite && std::isfinite(model.origin[axis]);
  if (!finite) return "the model has numbers that are not finite";
  return std::nullopt;
}

std::optional<std::string> defect(const Moments& moments, const Model& model) {
  if (moments.first.size() != model.logits.size() || moments.second.size() != model.logits.size() ||
      moments.vertex_first.size() != model.positions.size() ||
      moments.vertex_second.size() != model.positions.size() ||
      moments.steps.size() != model.faces())
    return "the moments do not match the model's size";
  return std::nullopt;
}

/// The first error in the checkpoint's state; nothing if it fits its configuration and views.
std::optional<std::string> defect(const Checkpoint& checkpoint) {
  const TrainingState& state = checkpoint.state;
  std::uint64_t pixels = 0;
  for (const ViewFingerprint& view : checkpoint.views) {
    if (view.width < 1 || view.width > max_side || view.height < 1 || view.height > max_side)
      return fmt::format("a view has an invalid size of {} x {} pixels", view.width, view.height);
    pixels += std::uint64_t(view.width) * std::uint64_t(view.height);
  }
  if (!std::isfinite(checkpoint.seconds) || checkpoint.seconds < 0)
    return "the training time is not a number of seconds";
  if (state.step < 0 || state.step > checkpoint.config.steps)
    return fmt::format("step {} is not from 0 to {}", state.step, checkpoint.config.steps);
  if (!state.baseline.empty() && state.baseline.size() != pixels)
    return fmt::format("the baseline has {} pixels, but the views have {}", state.baseline.size(),
                       pixels);
  if (auto reason = defect(state.model)) return reason;
  if (!state.errors.empty() && state.errors.size() != state.model.faces())
    return fmt::format("{} faces have errors, but the model has {} faces", state.errors.size(),
                       state.model.faces());
  return defect(state.moments, state.model);
}

/// Requires exactly the text that this version writes for the configuration: the text from an older
/// or newer version has other fields.
Config parsed_config(const std::string& text, const Input& input) {
  try {
    Input memory = Input::memory(input.name(), std::as_bytes(std::span(text)));
    const Config config = read_config(memory);
    if (config_to_json(config) == text) return config;
  } catch (const InputError& error) {
    throw InputError({input.name(), {}, {}}, "the configuration cannot be used: " + error.reason(),
                     error.hint());
  }
  throw InputError({input.name(), {}, {}},
                   "the configuration has other fields than this version of Tureen needs: resume "
                   "with the version that wrote it");
}

}  // namespace

std::vector<ViewFingerprint> fingerprint(std::span<const Photograph> photographs) {
  std::vector<ViewFingerprint> views;
  for (const Photograph& photograph : photographs) {
    const Camera& camera = photograph.camera;
    const std::array intrinsics{camera.fx, camera.fy, camera.cx, camera.cy};
    const std::uint32_t sum = checksum(0, std::as_bytes(std::span(intrinsics)));
    views.push_back({.name = camera.name,
                     .width = camera.width,
                     .height = camera.height,
                     .camera = checksum(sum, std::as_bytes(std::span(&camera.view_from_world, 1))),
                     .pixels = checksum(0, std::as_bytes(std::span(photograph.image.pixels)))});
  }
  return views;
}

void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint) {
  Output output(path);
  Writer writer(output);
  writer(magic, "");
  writer(checkpoint_version, "");
  writer(config_to_json(checkpoint.config), "");
  writer(std::uint64_t(checkpoint.views.size()), "");
  for (const ViewFingerprint& view : checkpoint.views) visit_view(writer, view);
  writer(checkpoint.seconds, "");
  visit_state(writer, checkpoint.state);
  output.write_value(writer.sum());
  output.commit();
}

Checkpoint read_checkpoint(Input& input) {
  Reader reader(input);
  Magic begin{};
  reader(begin, "the file's kind");
  if (begin != magic) input.fail_at(0, "this is not a checkpoint of tureen train");
  std::uint32_t version = 0;
  reader(version, "the version");
  if (version != checkpoint_version)
    input.fail_at(magic.size(), fmt::format("checkpoint version {} is not supported; this build "
                                            "reads version {}",
                                            version, checkpoint_version));
  Checkpoint checkpoint;
  std::string config;
  reader(config, "the configuration");
  std::uint64_t views = 0;
  reader(views, "the number of views");
  // Appended one by one: a wrong count then allocates no memory.
  for (std::uint64_t i = 0; i < views; ++i) visit_view(reader, checkpoint.views.emplace_back());
  reader(checkpoint.seconds, "the seconds so far");
  visit_state(reader, checkpoint.state);
  if (input.read_value<std::uint32_t>("the checksum") != reader.sum())
    input.fail_at(0, "the file is damaged: its checksum does not match its bytes");
  if (input.remaining() > 0) input.fail("the file has bytes after the end of the checkpoint");
  checkpoint.config = parsed_config(config, input);
  if (const auto reason = defect(checkpoint)) input.fail_at(0, *reason);
  return checkpoint;
}

Checkpoint read_checkpoint(const std::filesystem::path& path) {
  require_there(path);
  Input input = Input::open(path);
  return read_checkpoint(input);
}

std::optional<std::string> difference(const Config& now, const Config& checkpoint) {
  for (const ConfigField& field : config_fields()) {
    const std::string here = value_text(now, field), there = value_text(checkpoint, field);
    if (here != there)
      return fmt::format("{} is {}, but the checkpoint has {}", field.name, here, there);
  }
  return std::nullopt;
}

std::optional<std::string> difference(std::span<const ViewFingerprint> now,
                                      std::span<const ViewFingerprint> checkpoint) {
  if (now.size() != checkpoint.size())
    return fmt::format("the dataset has {} training views, but the checkpoint has {}", now.size(),
                       checkpoint.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    const ViewFingerprint &here = now[i], &there = checkpoint[i];
    if (here.name != there.name)
      return fmt::format("training view {} is {}, but the checkpoint has {}", i, here.name,
                         there.name);
    if (here.width != there.width || here.height != there.height)
      return fmt::format("{} is {} x {}, but the checkpoint has {} x {}", here.name, here.width,
                         here.height, there.width, there.height);
    if (here.camera != there.camera) return here.name + ": the camera differs from the checkpoint";
    if (here.pixels != there.pixels) return here.name + ": the pixels differ from the checkpoint";
  }
  return std::nullopt;
}

}  // namespace tureen::trainer
