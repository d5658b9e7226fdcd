#include "cli/evaluation.hpp"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <deque>
#include <future>
#include <set>
#include <thread>

#include "base/error.hpp"
#include "base/existing_path.hpp"
#include "base/output.hpp"
#include "cli/contact_sheet.hpp"
#include "cli/picture_file.hpp"
#include "image/heat_map.hpp"
#include "runtime/plan/plan_description.hpp"
#include "runtime/renderer.hpp"

namespace tureen::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* sheet_name = "contact_sheet.png";

struct Measured {
  ViewMetrics metrics;
  Image8 thumbnail;  // empty without a folder
};

/// What is left to do for a view once it is drawn. Runs on any thread.
Measured measure(const Photograph& photograph, const Image8& rendering,
                 const EvaluationOptions& options, const std::string& file) {
  const ImageF truth = composited(to_float(photograph.image), options.background);
  const ImageF drawn = to_float(rendering);
  const Metrics metrics = compare(truth, drawn, options.metrics);
  Measured result{{photograph.camera.name, metrics.psnr_db, metrics.ssim, metrics.flip}, {}};
  if (!options.folder.empty()) {
    Image8 picture = side_by_side(truth, drawn);
    // The photograph is shown over its background already.
    for (glm::u8vec4& pixel : picture.pixels) pixel.a = 255;
    write_picture(picture, options.folder / file);
    result.thumbnail = thumbnail(picture, 640);
  }
  return result;
}

/// Nothing that is there already inside `spared` is replaced: it may be a photograph.
void check_spared(const fs::path& spared, const fs::path& folder,
                  const std::vector<std::string>& files) {
  if (spared.empty() || folder.empty()) return;
  if (!lies_in(folder, spared)) return;
  std::error_code error;
  for (const std::string& file : files)
    if (fs::exists(folder / file, error))
      throw UsageError((folder / file).string() +
                           " is there already, and in the dataset's folder nothing is replaced",
                       "choose another folder for the pictures");
}

ViewMetrics mean_of(const std::vector<ViewMetrics>& views) {
  ViewMetrics sum;
  for (const ViewMetrics& view : views) {
    sum.psnr_db += view.psnr_db;
    sum.ssim += view.ssim;
    sum.flip += view.flip;
  }
  const double n = double(views.size());
  return {"", sum.psnr_db / n, sum.ssim / n, sum.flip / n};
}

}  // namespace

std::vector<std::string> picture_names(std::span<const Photograph> photographs) {
  std::set<std::string> taken{sheet_name};
  std::vector<std::string> names;
  for (const Photograph& photograph : photographs) {
    fs::path path = fs::path(photograph.camera.name).lexically_normal();
    std::string stem = path.replace_extension().string();
    for (char& c : stem)
      if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '.') c = '_';
    // A leading point would hide the file.
    stem.erase(0, stem.find_first_not_of("._"));
    if (stem.empty()) stem = "view";
    std::string name = stem + ".png";
    for (int n = 2; !taken.insert(name).second; ++n) name = stem + "_" + std::to_string(n) + ".png";
    names.push_back(name);
  }
  return names;
}

Evaluation evaluate(const TriangleSoup& soup, glm::dvec3 origin,
                    std::span<const Photograph> photographs, const EvaluationOptions& options) {
  assert(!photographs.empty());
  const std::vector<std::string> files = picture_names(photographs);
  check_spared(options.spared, options.folder, files);
  if (!options.folder.empty()) make_folder(options.folder);

  const gl::Context context = gl::Context::create({.backend = options.backend});
  Renderer renderer(context, soup, origin,
                    {.plan = options.plan, .background = {options.background, 1.0f}});
  Evaluation result;
  result.context = context.description();
  result.renderer = context.capabilities().renderer;

  std::vector<Image8> thumbnails;
  // One view more than cores is in memory at a time. Destroying what is left waits for it.
  const std::size_t most = std::max(1u, std::thread::hardware_concurrency());
  std::deque<std::future<Measured>> running;
  const auto take_first = [&] {
    Measured measured = running.front().get();
    running.pop_front();
    result.views.push_back(std::move(measured.metrics));
    if (options.folder.empty()) return;
    thumbnails.push_back(std::move(measured.thumbnail));
    result.output.push_back((options.folder / files[result.views.size() - 1]).string());
  };
  for (std::size_t i = 0; i < photographs.size(); ++i) {
    if (options.progress) options.progress(double(i) / double(photographs.size()));
    renderer.draw(photographs[i].camera);
    running.push_back(std::async(std::launch::async, measure, std::cref(photographs[i]),
                                 renderer.read_color(), std::cref(options), files[i]));
    if (running.size() == most) take_first();
  }
  while (!running.empty()) take_first();
  if (!options.folder.empty() && photographs.size() > 1) {
    const fs::path sheet = options.folder / sheet_name;
    write_picture(contact_sheet(thumbnails, 640), sheet);
    result.output.push_back(sheet.string());
  }
  result.mean = mean_of(result.views);
  result.plan = describe(renderer.plan());
  result.specialisations = renderer.plan().applied;
  return result;
}

Json to_json(const ViewMetrics& metrics, bool with_flip) {
  Json json = Json::object();
  if (!metrics.name.empty()) json["name"] = metrics.name;
  json["psnr_db"] = metrics.psnr_db;
  json["ssim"] = metrics.ssim;
  if (with_flip) json["flip"] = metrics.flip;
  return json;
}

}  // namespace tureen::cli
