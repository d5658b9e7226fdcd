// What each thing that a plan leaves out gains: a scene that has its trait, drawn by the whole plan
// and by the plan that keeps this one thing, the two in turns; and the same for real scenes and
// whatever their plans leave out. Only the ratios mean anything on another machine. Software GL is
// timed by the processor time of all its threads, which other programs hardly disturb.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "formats/scene_file.hpp"
#include "runtime/benchmark.hpp"
#include "runtime/navigation.hpp"
#include "runtime/renderer.hpp"
#include "support/cutout_cloud.hpp"
#include "support/trait_soups.hpp"

namespace tureen::test {
namespace {

struct Settings {
  int rounds = 5;
  int width = 1280, height = 720;
  std::vector<std::string> rows;
  bool real_scenes_only = false;
  std::vector<std::filesystem::path> scenes;

  bool wants(LeaveOut what) const {
    return rows.empty() || std::find(rows.begin(), rows.end(), name_of(what)) != rows.end();
  }
};

/// Two preferences of one scene against each other. Prints how many times as long a frame takes
/// without what the first leaves out.
void compare(const gl::Context& context, const Settings& settings, const char* row,
             const std::string& scene, const TriangleSoup& soup, std::span<const Camera> cameras,
             const PlanPreferences& kept) {
  Renderer with(context, soup, glm::dvec3(0.0));
  Renderer without(context, soup, glm::dvec3(0.0), {.plan = kept});
  const auto entrant = [](const char* name, Renderer& renderer) {
    return Entrant{name, [&renderer](const Camera& camera) { renderer.draw(camera); },
                   [&renderer] { renderer.finish(); }};
  };
  const Entrant entrants[] = {entrant("left out", with), entrant("kept", without)};
  BenchmarkOptions options{.rounds = settings.rounds};
  if (context.capabilities().software) options.clock = processor_seconds;
  const BenchmarkResult result = run_benchmark(entrants, cameras, options);
  const FrameStatistics fast = statistics_of(result.entrants[0].times),
                        slow = statistics_of(result.entrants[1].times);
  const double spread = std::max({result.aa_spread, fast.spread, slow.spread});
  std::printf("| %s | %s | %.2f | %.2f | %.3f | %.1f %% | %s | %.1f | %.1f |\n", row, scene.c_str(),
              slow.min_of_medians, fast.min_of_medians, slow.min_of_medians / fast.min_of_medians,
              100 * spread,
              !differ(slow.min_of_medians, fast.min_of_medians, spread) ? "no"
              : slow.min_of_medians > fast.min_of_medians               ? "yes"
                                                                        : "loses",
              double(without.device_bytes()) / (1 << 20), double(with.device_bytes()) / (1 << 20));
  std::fflush(stdout);
}

bool is_of_the_network(LeaveOut what) {
  switch (what) {
    case LeaveOut::color_mlp:
    case LeaveOut::base_color:
    case LeaveOut::view_direction:
    case LeaveOut::weight_uniforms:
    case LeaveOut::dead_neurons:
    case LeaveOut::latent_features:
      return true;
    default:
      return false;
  }
}

/// A large scene with the trait. Lattices are those of the cut-out cloud; the others are small
/// random triangles.
TriangleSoup large_soup(LeaveOut what, const Scene& cloud) {
  const Kind kind = kind_of_trait(what);
  TriangleSoup soup;
  if (kind == Kind::lattice_mlp || kind == Kind::lattice) {
    soup = std::get<TriangleSoup>(cloud.primitives);
    if (kind == Kind::lattice) std::get<LatticeTexture>(soup.appearance).mlp.reset();
  } else {
    // Some pixels large; those that are to lie between pixels a tenth of that, when they are split.
    const double size = what == LeaveOut::faces_between_pixels ? 0.005 : 0.02;
    soup = random_soup(1, {.kind = kind, .faces = 200000, .size = size, .degree = 3});
  }
  give_trait(what, soup);
  return soup;
}

void measure_traits(const gl::Context& context, const Settings& settings) {
  const Scene cloud = cutout_cloud({.width = settings.width, .height = settings.height});
  // A network shows what it costs where it runs on every pixel and little else is done.
  const Scene wall = cutout_cloud({.triangles = 1500,
                                   .level = 2,
                                   .coverage = CloudCoverage::all,
                                   .width = settings.width,
                                   .height = settings.height});
  for (const LeaveOutName& row : leave_out_names()) {
    if (!settings.wants(row.what)) continue;
    const Scene& base = is_of_the_network(row.what) ? wall : cloud;
    compare(context, settings, row.name, "made for it", large_soup(row.what, base), base.cameras,
            {.leave_out = LeaveOutSet::all().without(row.what)});
  }
}

void measure_scene(const gl::Context& context, const Settings& settings,
                   const std::filesystem::path& path) {
  Scene scene = read_scene(path);
  const TriangleSoup& soup = opaque_soup(scene);
  const Bounds box = bounds(soup);
  std::vector<Camera> cameras;
  for (int i = 0; i < 8; ++i) {
    const double angle = i * std::acos(-1.0) / 4;
    const glm::dvec3 up(scene.info.up),
        side = std::abs(up.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 a = glm::normalize(glm::cross(up, side)), b = glm::cross(up, a);
    const glm::dvec3 away = std::cos(angle) * a + std::sin(angle) * b + 0.4 * up;
    cameras.push_back(look_at(box.centre() + 2.2 * box.radius() * glm::normalize(away),
                              box.centre(), up, 0.7, settings.width, settings.height));
  }
  const std::string name = path.stem().string();
  const LeaveOutSet left_out = make_plan(soup, device_limits(context.capabilities())).left_out;
  for (const LeaveOutName& row : leave_out_names())
    if (left_out.has(row.what) && settings.wants(row.what))
      compare(context, settings, row.name, name, soup, cameras,
              {.leave_out = LeaveOutSet::all().without(row.what)});
  if (settings.rows.empty())
    compare(context, settings, "all of them", name, soup, cameras, {.specialise = false});
}

int run(int argc, char** argv) {
  Settings settings;
  CLI::App app("What each thing that a plan leaves out gains.");
  app.add_option("scenes", settings.scenes, "real scenes to measure, too");
  app.add_option("--rounds", settings.rounds, "how often the eight views are gone through");
  app.add_option("--rows", settings.rows, "these alone, by name")->delimiter(',');
  app.add_flag("--real-only", settings.real_scenes_only, "no scenes made for the purpose");
  app.add_option("--width", settings.width);
  app.add_option("--height", settings.height);
  CLI11_PARSE(app, argc, argv);
  const gl::Context context = gl::Context::create({});
  std::printf("%s, %d x %d, %s\n\n", context.capabilities().renderer.c_str(), settings.width,
              settings.height,
              context.capabilities().software ? "processor time" : "time by the wall");
  std::puts(
      "| left out | scene | kept ms | left out ms | times | spread | gains | kept MiB | left out "
      "MiB |");
  std::puts("|---|---|---|---|---|---|---|---|---|");
  if (!settings.real_scenes_only) measure_traits(context, settings);
  for (const auto& path : settings.scenes) measure_scene(context, settings, path);
  return 0;
}

}  // namespace
}  // namespace tureen::test

int main(int argc, char** argv) {
  try {
    return tureen::test::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "leave_out_benchmark: %s\n", error.what());
    return 1;
  }
}
