// Rays through the tree against rays without one, on one core, in the same process, by processor
// time; building and refitting the tree; an image with a mirror and a glass ball. Prints JSON
// lines.
//
// With two points, only rays of the camera between them.
//
//   trace_benchmark SCENE [EYE_X EYE_Y EYE_Z TARGET_X TARGET_Y TARGET_Z]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "base/threads/thread_pool.hpp"
#include "formats/scene_file.hpp"
#include "oracle/light.hpp"
#include "scene/middle_bounds.hpp"
#include "tests/bench/run_program.hpp"
#include "tests/tracing/tracing_scenes.hpp"
#include "tracing/kernels/ray_kernel.hpp"
#include "tracing/traced_images.hpp"

namespace tureen::test {
namespace {

using Json = nlohmann::ordered_json;

double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }
double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
double rounded(double value) { return std::round(1e4 * value) / 1e4; }
void print(const Json& line) {
  std::printf("%s\n", line.dump().c_str());
  std::fflush(stdout);
}

/// The rays of every `step`-th tile of 8 x 8 pixels.
std::vector<tracing::Ray> rays_of(const Camera& camera, int step) {
  std::vector<tracing::Ray> rays;
  int tile = 0;
  for (int y = 0; y + 8 <= camera.height; y += 8)
    for (int x = 0; x + 8 <= camera.width; x += 8)
      if (tile++ % step == 0)
        for (int i = 0; i < 64; ++i) {
          const glm::dvec3 view((x + i % 8 + 0.5 - camera.cx) / camera.fx,
                                (camera.cy - (y + i / 8) - 0.5) / camera.fy, -1.0);
          rays.push_back({camera.eye(), glm::normalize(camera.world_from_view_rotation() * view), 0,
                          1 / camera.fx});
        }
  return rays;
}

void measure_rays(const Scene& scene, const std::string& name, const Camera& camera) {
  const std::vector<tracing::Ray> rays = rays_of(camera, 16);
  const tracing::TracedScene traced(scene, glm::vec3(0.0f), in_order);
  const oracle::Light light(scene, glm::vec3(0.0f));
  // Hits and composited hits.
  const tracing::TracedLayer layer(scene.layers[0].primitives, scene.layers[0].world_from_layer, 0,
                                   0, in_order);
  std::vector<tracing::SplatOnRay> hits;
  std::size_t all = 0, composited = 0, meet = 0;
  for (const tracing::Ray& ray : rays) {
    hits.clear();
    layer.kernel().collect()(layer, layer.in_layer(ray, INFINITY), 0, 3e38f, hits);
    std::sort(hits.begin(), hits.end(), [](const auto& a, const auto& b) { return a.key < b.key; });
    all += hits.size();
    meet += !hits.empty();
    double transmittance = 1;
    for (const auto& hit : hits) {
      transmittance *= 1 - double(hit.alpha);
      if (transmittance < 1e-4) break;
      ++composited;
    }
  }
  tracing::RayMemory memory;
  double tree = 0, brute = 0, largest = 0;
  std::size_t traced_rays = 0, brute_rays = 0, above = 0;
  for (int round = 0; round < 5; ++round) {
    double start = cpu_seconds();
    for (const tracing::Ray& ray : rays) traced.light_along(ray, 1, 0, memory);
    tree += cpu_seconds() - start;
    traced_rays += rays.size();
    for (std::size_t i = std::size_t(round); i < rays.size(); i += 61) {
      const tracing::Ray& ray = rays[i];
      start = cpu_seconds();
      const glm::dvec3 expected = light.along({ray.origin, ray.direction, 0, ray.pixel});
      brute += cpu_seconds() - start;
      ++brute_rays;
      const glm::dvec3 error = glm::abs(traced.light_along(ray, 1, 0, memory) - expected);
      const double most = std::max({error.x, error.y, error.z});
      above += most > 1.0 / 255;
      largest = std::max(largest, most);
    }
  }
  const double rays_per_second = double(traced_rays) / tree;
  print({{"rays", name},
         {"hits", rounded(double(all) / double(rays.size()))},
         {"composited", rounded(double(composited) / double(rays.size()))},
         {"part_that_meets", rounded(double(meet) / double(rays.size()))},
         {"mrays_per_s", rounded(rays_per_second / 1e6)},
         {"brute_ms_per_ray", rounded(1000 * brute / double(brute_rays))},
         {"ratio", rounded(brute / double(brute_rays) * rays_per_second)},
         {"largest_error_255", rounded(255 * largest)},
         {"part_above_1_255", rounded(double(above) / double(brute_rays))}});
}

/// `copies` of the Gaussians beside each other.
Splats copies_of(const Splats& splats, std::size_t copies, float distance) {
  const auto& once = std::get<Gaussians>(splats.kernel);
  Gaussians all{.flat = once.flat};
  Splats result{.color = splats.color, .profile = splats.profile};
  result.color.coefficients.clear();
  for (std::size_t copy = 0; copy < copies; ++copy) {
    const glm::vec3 offset(float(copy % 4) * distance, float(copy / 4) * distance, 0);
    for (const glm::vec3& center : once.centers) all.centers.push_back(center + offset);
    all.scales.insert(all.scales.end(), once.scales.begin(), once.scales.end());
    all.rotations.insert(all.rotations.end(), once.rotations.begin(), once.rotations.end());
    all.opacity.insert(all.opacity.end(), once.opacity.begin(), once.opacity.end());
    result.color.coefficients.insert(result.color.coefficients.end(),
                                     splats.color.coefficients.begin(),
                                     splats.color.coefficients.end());
  }
  result.kernel = std::move(all);
  return result;
}

void measure_build(const Splats& splats, float size) {
  const Primitives primitives = copies_of(splats, 1000000 / count(splats) + 1, size);
  for (const int threads : {1, 2}) {
    ThreadPool pool(threads);
    const tracing::Parallel parallel = [&](std::size_t tasks, const auto& body) {
      pool.run(tasks, body);
    };
    double start = wall_seconds(), cpu = cpu_seconds();
    tracing::TracedLayer layer(primitives, glm::dmat4(1.0), 0, 0, parallel);
    const double build = wall_seconds() - start, build_cpu = cpu_seconds() - cpu;
    double least = 1e9, least_cpu = 1e9;
    for (int round = 0; round < 5; ++round) {
      start = wall_seconds(), cpu = cpu_seconds();
      layer.refit(primitives, parallel);
      least = std::min(least, wall_seconds() - start);
      least_cpu = std::min(least_cpu, cpu_seconds() - cpu);
    }
    print({{"splats", count(std::get<Splats>(primitives))},
           {"threads", threads},
           {"build_s", rounded(build)},
           {"build_cpu_s", rounded(build_cpu)},
           {"refit_s", rounded(least)},
           {"refit_cpu_s", rounded(least_cpu)},
           {"lanes_used", rounded(double(count(std::get<Splats>(primitives))) /
                                  double(layer.bvh().items().size()))},
           {"rebuilt", layer.was_rebuilt()}});
  }
}

void measure_image(Scene scene, const Camera& camera, const glm::dvec3& center, double radius) {
  const glm::dmat3 axes = camera.world_from_view_rotation();
  const glm::dvec3 towards = glm::normalize(camera.eye() - center);
  for (const double side : {-1.0, 1.0}) {
    const glm::dvec3 at = center + radius * (0.9 * towards + 0.5 * side * axes[0]);
    scene.layers.push_back(with(layer_of(unit_ball(4), ball_at(at, 0.35 * radius)),
                                side < 0 ? mirror_material() : glass_material(1.5f)));
  }
  const double start = wall_seconds(), cpu = cpu_seconds();
  tracing::TracedImages images(scene, {});
  const double ready = wall_seconds();
  images.exact_image({camera});
  print({{"image", "a mirror and a glass ball, 1280x720"},
         {"prepare_s", rounded(ready - start)},
         {"draw_s", rounded(wall_seconds() - ready)},
         {"cpu_s", rounded(cpu_seconds() - cpu)}});
}

int run(int argc, char** argv) {
  if (argc != 2 && argc != 8) throw std::runtime_error("needs SCENE, or SCENE and two points");
  const Scene scene = read_scene(argv[1]);
  const auto& splats = std::get<Splats>(scene.layers.at(0).primitives);
  const Bounds middle = middle_bounds(splats);
  const glm::dvec3 center = middle.center();
  const double radius = middle.radius();
  const auto camera = [&](double distance, int width, int height) {
    return look_at(center + distance * radius * glm::normalize(glm::dvec3(0.3, 0.2, 1)), center,
                   glm::dvec3(scene.info.up), 0.8, width, height);
  };
  if (argc == 8) {
    const auto point = [&](int first) {
      return glm::dvec3(std::atof(argv[first]), std::atof(argv[first + 1]),
                        std::atof(argv[first + 2]));
    };
    measure_rays(scene, "given", look_at(point(2), point(5), {0, 1, 0}, 0.8, 640, 360));
    return 0;
  }
  measure_rays(scene, "far", camera(2.2, 640, 360));
  measure_image(scene, camera(1.6, 1280, 720), center, radius);
  measure_build(splats, float(2 * radius));
  return 0;
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  return tureen::test::run_program("trace_benchmark", tureen::test::run, argc, argv);
}
