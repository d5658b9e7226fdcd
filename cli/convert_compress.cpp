#include "cli/convert_compress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/decimal_text.hpp"
#include "base/error.hpp"
#include "base/extension.hpp"
#include "cli/files/scene_page.hpp"
#include "cli/measuring/bench_words.hpp"
#include "cli/options/scene_argument.hpp"
#include "cli/progress.hpp"
#include "jobs/compress/compress.hpp"
#include "scene/edit/baked_transform.hpp"

namespace tureen::cli {

namespace {

/// "25 photographs", "24 of its 100 recorded cameras", "1 recorded camera and 23 views from above
/// and around", ..
std::string views_text(const CompressViews& views) {
  if (views.photographs > 0) return count_text(int(views.photographs), "photograph");
  if (views.around == 0)
    return fmt::format("{} of its {} recorded cameras", views.cameras, views.recorded);
  const std::string around = count_text(int(views.around), "view") + " from above and around";
  return views.cameras == 0 ? around
                            : count_text(int(views.cameras), "recorded camera") + " and " + around;
}

namespace fs = std::filesystem;

/// The name of the dataset's folder. The path above it may be private, and the file stores this
/// name.
std::string name_of(const DatasetArgument& dataset) {
  const fs::path folder = fs::path(dataset.path).lexically_normal();
  return (folder.has_filename() ? folder : folder.parent_path()).filename().string();
}

/// The cameras of the training photographs, at full size for any --scale. If the photographs cannot
/// be read, adds a sentence to `lost` and returns an empty list.
std::vector<Camera> training_cameras(const DatasetArgument& dataset,
                                     std::vector<std::string>& lost) {
  std::vector<Camera> cameras;
  try {
    for (const Photograph& photograph : read(dataset, DatasetPart::train).train) {
      const Camera& camera = photograph.camera;
      const double scale = dataset.options.scale;
      cameras.push_back(resized(camera, int(std::lround(camera.width / scale)),
                                int(std::lround(camera.height / scale))));
    }
  } catch (const InputError& error) {
    say(fmt::format("the training photographs of {} cannot be read: {}", name_of(dataset),
                    error.what()));
    lost.push_back(fmt::format(
        "Compression: the training cameras of {} are not used, because not all can be read.",
        name_of(dataset)));
    return {};
  }
  return cameras;
}

/// The views of the loss measurement: "9 photographs of fox at scale 0.25", or recorded cameras.
std::string measured_on(const CompressResult& result, const DatasetArgument& photographs) {
  if (photographs.path.empty()) return views_text(result.views);
  return fmt::format("{} of {} at scale {:g}", views_text(result.views), name_of(photographs),
                     photographs.options.scale);
}

/// Reasons why the actual loss may exceed the stated loss.
std::vector<std::string> doubts_about(const Scene& scene, bool with_photographs) {
  std::vector<std::string> doubts;
  if (scene.info.compressed)
    doubts.push_back(
        "Compression: the scene was already compressed. Its earlier loss adds to this one and is "
        "not included.");
  if (!with_photographs && scene.cameras.size() < min_representative_cameras)
    doubts.push_back(fmt::format(
        "Compression: {}, so the loss is estimated for views from above and around. For views from "
        "within the scene it may be much larger. --photographs measures it.",
        scene.cameras.empty()
            ? "the scene has no recorded cameras"
            : "the scene has only " + count_text(int(scene.cameras.size()), "recorded camera")));
  return doubts;
}

/// Sentences about the losses of compression; the file also stores them. `training_cameras`: number
/// of training cameras in the request.
std::vector<std::string> losses_of(const CompressResult& result, const DatasetArgument& photographs,
                                   std::size_t training_cameras) {
  const std::string views = measured_on(result, photographs);
  std::vector<std::string> losses{
      photographs.path.empty()
          ? fmt::format("Compression: estimated loss of PSNR {:.3f} dB or less, for a scene with a "
                        "PSNR of {:.0f} dB against its photographs. PSNR against the scene before "
                        "compression, in {}: {:.2f} dB.",
                        result.loss.db, result.model_db, views, result.loss.render_psnr_db)
          : fmt::format("Compression: loss of PSNR {:.3f} dB, against {} (before: {:.2f} dB). PSNR "
                        "against the scene before compression: {:.2f} dB.",
                        result.loss.db, views, result.model_db, result.loss.render_psnr_db),
      // A loss measured on photographs can be negative by chance; 0 is stated then.
      fmt::format("Compression: positions have {} bits ({:.3f} dB of the loss), colours a mean "
                  "step of {:.1f}/255. Colours of fully transparent texels are discarded.",
                  result.position_bits, std::max(result.geometry_loss.db, 0.0), result.color_step)};
  const auto texels = std::get<LatticeTexture>(result.kept.appearance).texel_count();
  if (result.lent_cameras > 0)
    losses.push_back(
        fmt::format("Compression: {} training cameras of {} replace recorded cameras in "
                    "determining the visible parts.",
                    result.lent_cameras, name_of(photographs)));
  else if (training_cameras > 0)
    losses.push_back(
        fmt::format("Compression: the {} training cameras of {} are not used, because fewer than "
                    "{} of them show the scene.",
                    training_cameras, name_of(photographs), min_representative_cameras));
  if (result.unseen_texels > 0)
    losses.push_back(
        fmt::format("Compression: {} of {} texels are invisible in {} recorded views and are "
                    "stored coarsely. They look smoother from other or nearer viewpoints.",
                    counted(result.unseen_texels), counted(texels), result.weighing_views));
  return losses;
}

}  // namespace

void add_compressed_arguments(Command& command, CompressArguments& arguments) {
  const Option compressed =
      command.add_flag("--compress,--slim", arguments.compressed,
                       "write a lossy compressed GLB: the smallest within --max-error");
  command
      .add_option("--max-error DB", arguments.max_error_db,
                  "with --compress: largest loss of PSNR against photographs in dB, 0.1 by default",
                  between(1e-4, 20.0))
      .needs(compressed);
  const Option photographs =
      command
          .add_option(
              "--photographs DATASET", arguments.photographs.path,
              "with --compress: dataset for measuring the loss on test photographs; by default the "
              "loss is estimated from images of the scene. If the scene has few cameras, the "
              "dataset's training cameras also decide which parts are visible. If you draw OUT at "
              "a larger size than the scaled photographs, the loss can exceed --max-error")
          .needs(compressed);
  add_scale_option(command, arguments.photographs).needs(photographs);
  command
      .add_flag("--keep-unseen", arguments.keep_unseen,
                "with --compress: keep unseen faces. By default they are removed if the scene has "
                "at least 8 recorded cameras, or if at least 8 training cameras of --photographs "
                "show it. A face is unseen if it appears in none of these views: up to 200 of "
                "these cameras, and 64 views from above and around")
      .needs(compressed);
  command
      .add_flag("--keep-cameras", arguments.keep_cameras,
                "with --compress: keep all recorded cameras; only the first by default")
      .needs(compressed);
}

void check_compressed(const CompressArguments& arguments, const fs::path& output) {
  if (arguments.compressed && extension_of(output) != ".glb" && !is_scene_page(output))
    throw UsageError("--compress writes .glb and .html files, not " + output.string());
}

Json convert_compressed(Scene scene, const CompressArguments& arguments, const fs::path& glb) {
  CompressRequest request{.max_loss_db = arguments.max_error_db,
                          .keep_unseen = arguments.keep_unseen};
  const bool with_photographs = !arguments.photographs.path.empty();
  const bool compressed_before = scene.info.compressed;
  std::vector<std::string> lost = doubts_about(scene, with_photographs);
  if (!is_translation(only_layer(scene))) {
    bake_transform(only_layer(scene));
    lost.push_back(
        "Compression: the layer's rotation, scale or mirror is applied to the positions.");
  }
  if (with_photographs) {
    Dataset dataset = read(arguments.photographs, DatasetPart::test);
    say_list("Reading " + arguments.photographs.path + ":", notes_of(dataset.remarks));
    request.photographs = std::move(dataset.test);
    if (request.photographs.empty())
      throw InputError({arguments.photographs.path}, "the dataset has no test photographs");
    if (scene.cameras.size() < min_representative_cameras)
      request.training_cameras = training_cameras(arguments.photographs, lost);
  }
  CompressResult result;
  {
    Progress progress("compressing");
    request.progress = [&](double fraction) { progress.update(fraction); };
    result = compress(scene, request);
  }
  for (std::string& sentence :
       losses_of(result, arguments.photographs, request.training_cameras.size()))
    lost.push_back(std::move(sentence));
  const auto all_faces = only_soup(scene).triangles.size();
  if (result.unseen > 0)
    lost.push_back(fmt::format(
        "Compression: {} OF {} FACES ARE REMOVED, because they are invisible in {} views (recorded "
        "cameras, and from above and around). Other or nearer viewpoints may show holes.",
        counted(result.unseen), counted(all_faces), result.seeing_views));
  only_layer(scene).primitives = std::move(result.kept);
  const std::size_t cameras = scene.cameras.size();
  if (!arguments.keep_cameras && cameras > 1) {
    scene.cameras.resize(1);
    lost.push_back(
        fmt::format("Compression: only the first of {} recorded cameras is kept.", cameras));
  }
  const Json remarks = remarks_json(scene.info.remarks);
  // The file stores the losses of reading and of compressing.
  const Json notes = notes_of(scene.info);
  scene.info.notes = all_notes(scene.info);
  scene.info.remarks.clear();
  scene.info.notes.insert(scene.info.notes.end(), lost.begin(), lost.end());
  // This concerns the file and not the scene, so the notes omit it.
  lost.push_back(
      "Compression: only Tureen reads this file. It has no mesh for other glTF viewers.");
  for (std::string& sentence : write_compressed_glb(scene, result.soup, glb))
    lost.push_back(std::move(sentence));

  const std::uint64_t bytes = bytes_on_disk(glb);
  say_list("Lost by --compress:", lost);
  const auto faces = only_soup(scene).triangles.size();
  say(fmt::format("the scene takes {}: positions {}, texels {}, {:.1f} bytes a triangle",
                  bytes_text(bytes), bytes_text(result.soup.geometry.size()),
                  bytes_text(result.soup.texels.size()),
                  double(bytes) / double(std::max<std::size_t>(faces, 1))));
  return {{"scene_bytes", bytes},
          {"geometry_bytes", result.soup.geometry.size()},
          {"texel_bytes", result.soup.texels.size()},
          {"position_bits", result.position_bits},
          {"color_step", result.color_step},
          {"loss_db", result.loss.db},
          {"loss_is_measured", with_photographs},
          {"render_psnr_db", result.loss.render_psnr_db},
          {"views", views_text(result.views)},
          {"recorded_cameras", cameras},
          {"training_cameras", result.lent_cameras},
          {"compressed_before", compressed_before},
          {"faces_left_out", result.unseen},
          {"texels_kept_roughly", result.unseen_texels},
          {"notes", notes},
          {"remarks", remarks},
          {"lost", lost}};
}

}  // namespace tureen::cli
