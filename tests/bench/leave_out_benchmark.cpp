// What each thing that a plan leaves out gains: a scene that has its trait, drawn by the whole plan
// and by the plan that keeps this one thing, the two in turns; and the same for real scenes and
// whatever their plans leave out. Only the ratios mean anything on another machine. Software GL is
// timed by the processor time of all its threads, which other programs hardly disturb.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/bench_words.hpp"
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

/// Whether a plan gains by what it leaves out.
/// Of two that took turns frame by frame, view by view: what troubled the machine met both frames
/// of a pair, so that pairs tell more than the medians of rounds, between which the machine
/// changes.
struct Pairs {
  std::size_t count = 0, slower = 0;  // in `slower` of them the second took longer
  double median_ratio = 1;            // of the second's time to the first's
};

Pairs pairs_of(const FrameTimes& first, const FrameTimes& second) {
  Pairs result{.count = first.ms.size()};
  std::vector<double> ratios;
  for (std::size_t i = 0; i < result.count; ++i) {
    ratios.push_back(second.ms[i] / first.ms[i]);
    result.slower += ratios.back() > 1 ? 1 : 0;
  }
  result.median_ratio = percentile(ratios, 50);
  return result;
}

/// By the sign test: were the two alike, the second would take longer in half of n pairs, and
/// within 2.58 sqrt(n) / 2 of that ninety-nine times in a hundred.
const char* gain_text(const Pairs& pairs) {
  const double half = 0.5 * double(pairs.count), away = double(pairs.slower) - half;
  if (std::abs(away) <= 1.29 * std::sqrt(double(pairs.count))) return "no";
  return away > 0 ? "yes" : "loses";
}

/// Two preferences of one scene against each other. Prints how many times as long a frame takes
/// without what the first leaves out, by pairs of frames, and says whether both warm-ups came to
/// rest.
bool compare(const gl::Context& context, const Settings& settings, const char* row,
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
  const Pairs pairs = pairs_of(result.entrants[0].times, result.entrants[1].times);
  const auto mark = [&](std::size_t which) {
    return result.entrants[which].stable ? "" : cli::restless_mark;
  };
  std::printf("| %s | %s | %.2f%s | %.2f%s | %.3f | %zu of %zu | %s | %.1f | %.1f |\n", row,
              scene.c_str(), slow.median, mark(1), fast.median, mark(0), pairs.median_ratio,
              pairs.slower, pairs.count, gain_text(pairs),
              double(without.device_bytes()) / (1 << 20), double(with.device_bytes()) / (1 << 20));
  std::fflush(stdout);
  return result.entrants[0].stable && result.entrants[1].stable;
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

bool measure_traits(const gl::Context& context, const Settings& settings) {
  const Scene cloud = cutout_cloud({.width = settings.width, .height = settings.height});
  // A network shows what it costs where it runs on every pixel and little else is done.
  const Scene wall = cutout_cloud({.triangles = 1500,
                                   .level = 2,
                                   .coverage = CloudCoverage::all,
                                   .width = settings.width,
                                   .height = settings.height});
  bool at_rest = true;
  for (const LeaveOutName& row : leave_out_names()) {
    if (!settings.wants(row.what)) continue;
    const Scene& base = is_of_the_network(row.what) ? wall : cloud;
    at_rest &= compare(context, settings, row.name, "made for it", large_soup(row.what, base),
                       base.cameras, {.leave_out = LeaveOutSet::all().without(row.what)});
  }
  return at_rest;
}

bool measure_scene(const gl::Context& context, const Settings& settings,
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
  bool at_rest = true;
  for (const LeaveOutName& row : leave_out_names())
    if (left_out.has(row.what) && settings.wants(row.what))
      at_rest &= compare(context, settings, row.name, name, soup, cameras,
                         {.leave_out = LeaveOutSet::all().without(row.what)});
  if (settings.rows.empty())
    at_rest &=
        compare(context, settings, "all of them", name, soup, cameras, {.specialise = false});
  return at_rest;
}

std::vector<std::string> row_names() {
  std::vector<std::string> names;
  for (const LeaveOutName& row : leave_out_names()) names.emplace_back(row.name);
  return names;
}

int run(int argc, char** argv) {
  Settings settings;
  CLI::App app("What each thing that a plan leaves out gains.");
  app.add_option("scenes", settings.scenes, "real scenes to measure, too");
  app.add_option("--rounds", settings.rounds, "how often the eight views are gone through")
      ->check(CLI::PositiveNumber);
  app.add_option("--rows", settings.rows, "these alone, by name")
      ->delimiter(',')
      ->check(CLI::IsMember(row_names()));
  app.add_flag("--real-only", settings.real_scenes_only, "no scenes made for the purpose");
  app.add_option("--width", settings.width)->check(CLI::PositiveNumber);
  app.add_option("--height", settings.height)->check(CLI::PositiveNumber);
  CLI11_PARSE(app, argc, argv);
  const gl::Context context = gl::Context::create({});
  std::printf("%s, %d x %d, %d rounds, %s\n\n", context.capabilities().renderer.c_str(),
              settings.width, settings.height, settings.rounds,
              context.capabilities().software ? "processor time" : "time by the wall");
  std::puts(
      "| left out | scene | kept ms | left out ms | times | slower in | gains | kept MiB | left "
      "out "
      "MiB |");
  std::puts("|---|---|---|---|---|---|---|---|---|");
  bool at_rest = settings.real_scenes_only || measure_traits(context, settings);
  for (const auto& path : settings.scenes) at_rest &= measure_scene(context, settings, path);
  if (!at_rest) std::printf("\n%s\n", cli::restless_sentence);
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
