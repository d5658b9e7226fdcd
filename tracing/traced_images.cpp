#include "tracing/traced_images.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <numeric>
#include <thread>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "scene/clip_range.hpp"

namespace tureen::tracing {

namespace {

/// Pixels of one task: neighbours, whose rays are saturated at similar distances.
constexpr int block_side = 16;

/// The offset of sample `i` from the pixel's centre: points of the additive recurrence with the
/// plastic number (Roberts, 2018), which fill the pixel evenly for any number; the first lies at
/// the centre.
glm::dvec2 jitter(int i) {
  constexpr double g = 1.32471795724474602596;
  const auto wrapped = [](double value) { return value - std::floor(value); };
  return {wrapped(0.5 + i / g) - 0.5, wrapped(0.5 + i / (g * g)) - 0.5};
}

glm::dvec2 grid_point(int i, int side) {
  return glm::dvec2(i % side + 0.5, i / side + 0.5) / double(side) - 0.5;
}

/// The camera whose pixel centres lie at these offsets from those of `camera`.
Camera shifted(Camera camera, const glm::dvec2& offset) {
  camera.cx -= offset.x;
  camera.cy -= offset.y;
  return camera;
}

}  // namespace

class TracedImages::Sample {
 public:
  Sample(TracedImages& images, const Camera& camera, const Camera& whole)
      : images_(images),
        camera_(camera),
        whole_(whole),
        pixels_(std::size_t(camera.width) * std::size_t(camera.height)) {}

  /// Premultiplied, over nothing. `from`, `to`: of the progress.
  std::vector<glm::dvec4> drawn(double from, double to) {
    const bool has_surfaces = images_.traced_.has_surfaces();
    if (has_surfaces) find_surfaces(from, from + 0.3 * (to - from));
    rgba_.assign(4 * pixels_, 0.0f);
    if (!images_.splats_.empty()) blend_splats();
    if (has_surfaces) light_surfaces(from + 0.5 * (to - from), to);
    std::vector<glm::dvec4> result(pixels_);
    for (std::size_t i = 0; i < pixels_; ++i)
      result[i] = {rgba_[4 * i], rgba_[4 * i + 1], rgba_[4 * i + 2], rgba_[4 * i + 3]};
    return result;
  }

 private:
  Ray ray_of(int column, int row) const {
    const glm::dvec3 view((column + 0.5 - camera_.cx) / camera_.fx,
                          (camera_.cy - row - 0.5) / camera_.fy, -1.0);
    return {eye_, glm::normalize(rotation_ * view), 0, 1 / std::sqrt(camera_.fx * camera_.fy)};
  }
  /// Calls act(pixel, ray) for all, block by block.
  void for_each_ray(double from, double to,
                    const std::function<void(std::size_t, const Ray&)>& act) {
    const int columns = (camera_.width + block_side - 1) / block_side;
    const int rows = (camera_.height + block_side - 1) / block_side;
    images_.run(std::size_t(columns) * std::size_t(rows), from, to, [&](std::size_t block) {
      const int x = int(block) % columns * block_side, y = int(block) / columns * block_side;
      for (int row = y; row < std::min(y + block_side, camera_.height); ++row)
        for (int column = x; column < std::min(x + block_side, camera_.width); ++column)
          act(std::size_t(row) * std::size_t(camera_.width) + std::size_t(column),
              ray_of(column, row));
    });
  }

  void find_surfaces(double from, double to) {
    surfaces_.resize(pixels_);
    depths_.resize(pixels_);
    const glm::dvec3 forward = rotation_ * glm::dvec3(0, 0, -1);
    for_each_ray(from, to, [&](std::size_t i, const Ray& ray) {
      surfaces_[i] = images_.traced_.surface_on(ray);
      depths_[i] = float(surfaces_[i].distance * glm::dot(ray.direction, forward));
    });
  }

  void blend_splats() {
    const double near = clip_range(images_.places_, camera_, DepthStorage::reversed_float).near;
    std::vector<splatting::LayerInView> views;
    for (const DrawnSplats& layer : images_.splats_) {
      const glm::dmat3 linear(layer.place.world_from_layer);
      const double scale = std::cbrt(std::abs(glm::determinant(linear)));
      const glm::dmat3 turn = linear / scale;  // a rotation or reflection
      Camera own = camera_;
      own.view_from_world = glm::dmat4(glm::dmat3(camera_.view_from_world) * turn);
      const glm::dvec3 eye =
          glm::transpose(turn) * (eye_ - glm::dvec3(layer.place.world_from_layer[3])) / scale;
      views.push_back({layer.splats,
                       splatting::image_view(own, eye, near / scale, *layer.profile, whole_),
                       scale});
    }
    images_.tiles_.draw(
        views, depths_,
        [&](int first_row, std::span<const float> rows) {
          std::copy(rows.begin(), rows.end(),
                    rgba_.begin() + 4 * std::ptrdiff_t(first_row) * camera_.width);
        },
        splatting::BlendOrder::along_rays);
  }

  void light_surfaces(double from, double to) {
    for_each_ray(from, to, [&](std::size_t i, const Ray& ray) {
      if (!surfaces_[i].exists()) return;
      thread_local RayMemory memory;  // no result depends on it
      const double through = 1 - double(rgba_[4 * i + 3]);
      const glm::dvec3 light = images_.traced_.light_of(surfaces_[i], ray, through, 0, memory);
      for (std::size_t c = 0; c < 3; ++c) rgba_[4 * i + c] += float(through * light[int(c)]);
      rgba_[4 * i + 3] = 1;
    });
  }

  TracedImages& images_;
  const Camera camera_, whole_;
  const glm::dvec3 eye_ = camera_.eye();
  const glm::dmat3 rotation_ = camera_.world_from_view_rotation();
  const std::size_t pixels_;
  std::vector<SurfaceOnRay> surfaces_;
  std::vector<float> depths_;
  std::vector<float> rgba_;
};

TracedImages::TracedImages(TraceOptions options)
    : options_(std::move(options)),
      pool_(options_.threads),
      traced_(options_.background.value_or(glm::vec3(0.0f))),
      tiles_([this](std::size_t count, const std::function<void(std::size_t)>& body) {
        run(count, done_, done_, body);
      }) {
  assert(options_.samples >= 1 && options_.supersampling >= 1);
}

TracedImages::TracedImages(const Scene& scene, TraceOptions options)
    : TracedImages(std::move(options)) {
  sync(layers_for_rays(scene));
}

const TracedImages::TiledLayer& TracedImages::tiled(const DocumentLayer& layer) {
  std::erase_if(tiled_, [&](const TiledLayer& each) {
    return each.id == layer.id && each.primitives != layer.primitives;
  });
  const auto known = std::find_if(tiled_.begin(), tiled_.end(),
                                  [&](const TiledLayer& each) { return each.id == layer.id; });
  if (known != tiled_.end()) return *known;
  TiledLayer made{layer.id, layer.primitives, {}, {}};
  if (const auto* splats = std::get_if<Splats>(layer.primitives.get())) {
    if (!splatting::has_layer_for(*splats))
      throw UsageError("a layer has too many splats for rays: " + counted(count(*splats), "splat"));
    std::vector<std::uint32_t> all(count(*splats));
    std::iota(all.begin(), all.end(), 0u);
    made.splats = splatting::make_layer(
        splatting::layer_data(*splats, splats->profile, all, splats->color.degree));
    made.bounds = bounds(*splats);
  } else {
    made.bounds = bounds(std::get<TriangleSoup>(*layer.primitives));
  }
  return tiled_.emplace_back(std::move(made));
}

void TracedImages::sync(const std::vector<DocumentLayer>& layers) {
  splats_.clear();
  places_.clear();
  std::erase_if(tiled_, [&](const TiledLayer& each) {
    return std::none_of(layers.begin(), layers.end(),
                        [&](const DocumentLayer& layer) { return layer.id == each.id; });
  });
  bool turns = false;  // whether rays may be reflected or refracted
  for (const DocumentLayer& layer : layers) {
    if (!layer.visible) continue;
    report(0);
    turns |= layer.material && (is_mirror(*layer.material) || is_glass(*layer.material));
    const TiledLayer& own = tiled(layer);
    places_.push_back({own.bounds, layer.world_from_layer});
    if (own.splats)
      splats_.push_back(
          {own.splats.get(), &std::get<Splats>(*own.primitives).profile, places_.back()});
  }
  std::vector<DocumentLayer> met = layers;
  for (DocumentLayer& layer : met)
    layer.visible &= turns || std::holds_alternative<TriangleSoup>(*layer.primitives);
  traced_.sync(met, [&](std::size_t count, const std::function<void(std::size_t)>& body) {
    run(count, 0, 0, body);
  });
}

void TracedImages::run(std::size_t tasks, double from, double to,
                       const std::function<void(std::size_t)>& body) {
  const std::thread::id caller = std::this_thread::get_id();
  pool_.run(tasks, [&](std::size_t i) {
    body(i);
    // Tasks are taken in order: the index is about the number of those that are done.
    if (std::this_thread::get_id() == caller)
      report(from + (to - from) * double(i + 1) / double(tasks));
  });
}

void TracedImages::report(double done) {
  done_ = done;
  try {
    if (options_.progress) options_.progress(done);
  } catch (...) {
    is_cancelled_ = true;
    throw;
  }
}

std::vector<glm::dvec4> TracedImages::sample_at(const FrameInput& input, const glm::dvec2& offset,
                                                double from, double to) {
  done_ = from;
  const Camera& whole = input.whole.value_or(input.camera);
  return Sample(*this, shifted(input.camera, offset), shifted(whole, offset)).drawn(from, to);
}

std::vector<glm::dvec4> TracedImages::sample(const FrameInput& input, int i) {
  return sample_at(input, jitter(i), 0, 1);
}

glm::vec4 TracedImages::mean(const glm::dvec4& sum, int samples) const {
  const double coverage = sum.a / samples;
  glm::dvec3 color = glm::dvec3(sum) / double(samples);
  if (options_.background)
    color += (1 - coverage) * glm::dvec3(*options_.background);
  else if (coverage > 0)
    color /= coverage;
  return {glm::clamp(color, 0.0, 1.0), coverage};
}

std::optional<ImageF> TracedImages::exact_image(const FrameInput& input) {
  is_cancelled_ = false;
  const Camera& camera = input.camera;
  const int side = options_.supersampling;
  int count = side > 1 ? side * side : options_.samples, done = 0;
  std::vector<glm::dvec4> sums(std::size_t(camera.width) * std::size_t(camera.height));
  for (int i = 0; i < count; ++i) {
    const glm::dvec2 offset = side > 1 ? grid_point(i, side) : jitter(i);
    try {
      const auto own = sample_at(input, offset, double(i) / count, double(i + 1) / count);
      for (std::size_t p = 0; p < sums.size(); ++p) sums[p] += own[p];
      ++done;
      report(double(done) / count);
    } catch (...) {
      // Jittered samples fill the pixel after any number, but a grid only after all.
      if (!is_cancelled_ || done == 0 || side > 1) throw;
      count = done;
    }
  }
  ImageF image(camera.width, camera.height);
  for (std::size_t p = 0; p < sums.size(); ++p) image.pixels[p] = mean(sums[p], count);
  return image;
}

}  // namespace tureen::tracing
