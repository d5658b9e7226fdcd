#include "bench/page/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "bench/page/frames_section.hpp"
#include "bench/page/growth_section.hpp"
#include "bench/page/tradeoff_section.hpp"
#include "soup/error.hpp"

namespace tureen::test {

namespace {

namespace fs = std::filesystem;

Section slim_section(const Measurements& measurements, const std::vector<std::string>& names) {
  Section section{.name = "slim", .text = head(measurements, names), .plots = {}};
  Table table({"scene", "published export, bytes", "slim, bytes", "times smaller", "loss dB",
               "against the scene before, dB", "faces left out"});
  for (const std::string& name : names) {
    const Json slim = measurements.printed(name);
    table.line({name.substr(std::string("slim-").size()),
                number_or_none(slim.value("published_bytes", Json()), "{:.0f}"),
                number_or_none(slim.at("scene_bytes"), "{:.0f}"),
                number_or_none(slim.value("times_smaller", Json()), "{:.2f}"),
                fmt::format("{:.3f}, {}", slim.at("loss_db").get<double>(),
                            slim.at("loss_is_measured").get<bool>() ? "measured" : "estimated"),
                number_or_none(slim.at("render_psnr_db"), "{:.2f}"),
                number_or_none(slim.at("faces_left_out"), "{:.0f}")});
  }
  section.text += table.text();
  return section;
}

/// A line a run, without their plots.
Section training_section(const Measurements& measurements, const std::string& kind,
                         const std::vector<std::string>& names) {
  Section section{.name = kind, .text = head(measurements, names), .plots = {}};
  Table table({"run", "steps", "triangles", "test views", "PSNR dB", "SSIM", "FLIP",
               "as the trainer draws, dB", "texels clear or opaque", "put aside", "seconds"});
  for (const std::string& name : names) {
    const Json run = measurements.printed(name), &test = run.at("test");
    table.line(
        {name.substr(kind.size() + 1), number_or_none(run.at("steps"), "{:.0f}"),
         number_or_none(run.at("triangles"), "{:.0f}"), number_or_none(test.at("views"), "{:.0f}"),
         number_or_none(test.at("psnr_db"), "{:.2f}"),
         number_or_none(test.value("ssim", Json()), "{:.4f}"),
         number_or_none(test.value("flip", Json()), "{:.4f}"),
         number_or_none(run.at("trainer_psnr_db"), "{:.2f}"),
         percent(run.at("opacity_binary_fraction")), number_or_none(run.at("non_finite"), "{:.0f}"),
         number_or_none(run.at("seconds"), "{:.0f}")});
  }
  section.text += table.text();
  return section;
}

Section train_section(const Measurements& measurements, const std::vector<std::string>& names) {
  Section section = training_section(measurements, "train", names);
  for (const std::string& name : names)
    add_plot(
        section, measurements.file(name, "log.svg"),
        name.substr(std::string("train-").size()) + ": loss against steps, PSNR against seconds");
  return section;
}

/// Tables one below the other.
Section agreement_section(const Measurements& measurements, const std::vector<std::string>& names) {
  Section section{.name = "agreement", .text = head(measurements, names)};
  for (const std::string& name : names)
    section.text += measurements.text_of(name, "table.md") + "\n";
  return section;
}

/// Kinds that have one section for all, by what their names begin with.
struct Kind {
  const char* name;
  Section (*section)(const Measurements&, const std::vector<std::string>&);
};
constexpr Kind kinds[] = {
    {"gpu", gpu_section},
    {"stages", stages_section},
    {"slim", slim_section},
    {"agreement", agreement_section},
    {"train", train_section},
    {"ablation",
     [](const auto& all, const auto& names) { return training_section(all, "ablation", names); }},
};

Section section_of(const Measurements& measurements, const std::string& name) {
  const auto wrote = [&](const char* file) { return fs::exists(measurements.file(name, file)); };
  if (wrote("bench.json")) return bench_section(measurements, name);
  if (wrote("tradeoff.json")) return tradeoff_section(measurements, name);
  if (wrote("scenes.json")) return scenes_section(measurements, name);
  if (wrote("growth.json")) return growth_section(measurements, name);
  const std::string table =
      wrote("table.md") ? measurements.text_of(name, "table.md") : measurements.text(name);
  return {name, head(measurements, {name}) + table + "\n"};
}

}  // namespace

Sections sections_of(const Measurements& measurements) {
  Sections sections;
  const auto add = [&](const std::string& name, auto&& make) {
    try {
      sections.made.push_back(make());
    } catch (const nlohmann::json::exception& error) {
      sections.failures.push_back(name + ": " + error.what());
    } catch (const InputError& error) {
      sections.failures.push_back(name + ": " + error.what());
    }
  };
  std::vector<std::string> told;
  for (const Kind& kind : kinds) {
    const auto names = measurements.beginning_with(std::string(kind.name) + "-");
    if (names.empty()) continue;
    add(kind.name, [&] { return kind.section(measurements, names); });
    told.insert(told.end(), names.begin(), names.end());
  }
  for (const std::string& name : measurements.names())
    if (std::find(told.begin(), told.end(), name) == told.end())
      add(name, [&] { return section_of(measurements, name); });
  return sections;
}

}  // namespace tureen::test
