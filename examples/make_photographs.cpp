// Renders the training images of the example soup: the still life from all directions. The images
// are the same bytes with any number of threads.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "base/output.hpp"
#include "examples/nerf_synthetic.hpp"
#include "examples/parallel.hpp"
#include "examples/photograph.hpp"
#include "examples/still_life.hpp"
#include "image/png.hpp"

namespace {

using namespace tureen;
using namespace tureen::example;

struct Options {
  std::filesystem::path folder;
  int size = 400, views = 100, test_views = 12, strata = 6;
  int threads = int(std::max(1u, std::thread::hardware_concurrency()));
};

/// Writes the images first and the JSON that lists them last, so that an interrupted split is not
/// read.
void take(const Studio& studio, const Options& options, const std::string& split,
          const std::vector<Camera>& cameras) {
  const int count = int(cameras.size());
  std::filesystem::create_directories(options.folder / split);
  std::atomic<int> taken = 0;
  in_parallel(count, options.threads, [&](int i) {
    Output output(options.folder / split / (cameras[i].name + ".png"));
    output.write(encode_png(studio.photograph(cameras[i], options.strata)));
    output.commit();
    const int done = ++taken;
    if (done % 10 == 0 || done == count)
      std::fprintf(stderr, "%s: %d of %d\n", split.c_str(), done, count);
  });
  write_transforms(options.folder, split, cameras);
}

int run(int argc, char** argv) {
  CLI::App app("Renders the example's still life as a dataset in the layout of NeRF-synthetic.");
  Options options;
  app.add_option("FOLDER", options.folder, "Folder of the dataset")->required();
  app.add_option("--size", options.size, "Pixels per side")
      ->check(CLI::Range(11, 4096))  // the sizes that training supports
      ->capture_default_str();
  app.add_option("--views", options.views, "Number of training images")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--test-views", options.test_views, "Number of test images")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--strata", options.strata, "Rays per pixel along each axis")
      ->check(CLI::Range(1, 32))
      ->capture_default_str();
  app.add_option("--threads", options.threads)->check(CLI::Range(1, 1024));
  CLI11_PARSE(app, argc, argv);
  std::filesystem::create_directories(
      options.folder);  // fails before the light, which takes minutes
  std::fprintf(stderr, "computing the light (1 to 2 minutes)\n");
  const Studio studio(still_life(), {.threads = options.threads});
  take(studio, options, "train", example_cameras(options.views, options.size));
  take(studio, options, "test", example_cameras(options.test_views, options.size, 0.5));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_photographs: %s\n", error.what());
    return 5;
  }
}
