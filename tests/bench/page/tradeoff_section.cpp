#include "bench/page/tradeoff_section.hpp"

#include <fmt/format.h>

namespace tureen::test {

namespace {

/// One knob at a time and whatever is on the front; every combination stands in the page that the
/// program wrote.
bool is_told(const Json& configuration, const Json& knobs) {
  if (configuration.at("method") == "tureen --no-specialise") return false;
  if (configuration.at("on_front").get<bool>()) return true;
  int turned = 0;
  for (const Json& knob : knobs)
    turned +=
        configuration.at("knobs").at(knob.at("key").get<std::string>()) != knob.at("settings").at(0)
            ? 1
            : 0;
  return turned <= 1;
}

std::string told_name(const Json& configuration) {
  const bool is_emulated = configuration.at("method") == "oracle";
  return configuration.at("name").get<std::string>() + (is_emulated ? " (emulated)" : "");
}

std::string panel_table(const Json& panel, bool with_exact) {
  std::vector<std::string> headings{"configuration", "ms",   "p95 ms", "MiB",
                                    "PSNR dB",       "SSIM", "max",    "mismatch"};
  if (with_exact) headings.insert(headings.begin() + 5, "exact dB");
  headings.emplace_back("");
  Table table(headings);
  std::string warned;
  for (const Json& each : panel.at("configurations")) {
    if (!is_told(each, panel.at("knobs"))) continue;
    const Json& error = each.at("e_render");
    std::vector<std::string> cells{told_name(each),
                                   number_or_none(each.at("ms"), "{:.2f}"),
                                   number_or_none(each.at("ms_p95"), "{:.2f}"),
                                   number_or_none(each.at("mib"), "{:.1f}"),
                                   number_or_none(error.at("psnr_db"), "{:.2f}"),
                                   number_or_none(error.at("ssim"), "{:.5f}"),
                                   number_or_none(error.at("max"), "{:.3f}"),
                                   number_or_none(error.at("coverage"), "{:.1e}")};
    if (with_exact) {
      const Json& exact = each.at("e_render_exact");
      cells.insert(cells.begin() + 5,
                   exact.is_null() ? "–" : number_or_none(exact.at("psnr_db"), "{:.2f}"));
    }
    cells.emplace_back(each.at("on_front").get<bool>() ? "front" : "");
    const Json& warnings = each.at("warnings");
    if (!warnings.empty()) cells.back() += "†";
    for (const Json& warning : warnings)
      warned += fmt::format("† {}: {}.\n\n", told_name(each), warning.get<std::string>());
    table.line(cells);
  }
  return table.text() + warned +
         fmt::format(
             "{} configurations were measured. A/A spread {}; hypervolume against the corner at "
             "100 ms and 20 dB: {:.1f} decade dB; the reference itself in 8 bits (R1): {:.2f} "
             "dB.\n\n",
             panel.at("configurations").size(), percent(panel.at("aa_spread")),
             panel.at("hypervolume_decade_db").get<double>(),
             panel.at("r1").at("psnr_db").get<double>());
}

std::string model_table(const Json& tradeoff) {
  const Json& protocol = tradeoff.at("e_model");
  if (protocol.is_null()) return {};
  Table table({"configuration", "PSNR dB", "SSIM"});
  for (const char* panel : {"drawing", "antialiasing"})
    for (const Json& each : tradeoff.at(panel).at("configurations")) {
      const Json& model = each.at("e_model");
      if (!model.is_null())
        table.line({told_name(each), number_or_none(model.at("psnr_db"), "{:.2f}"),
                    number_or_none(model.at("ssim"), "{:.4f}")});
    }
  return fmt::format("E_model, against {} photographs ({}):\n\n",
                     protocol.at("photographs").get<int>(),
                     protocol.at("split").get<std::string>()) +
         table.text();
}

std::string choice_text(const Json& tradeoff) {
  const Json& limits = tradeoff.at("limits");
  const std::string kept = fmt::format("at least {:g} dB and a coverage mismatch of at most {:g}",
                                       limits.at("least_psnr_db").get<double>(),
                                       limits.at("most_coverage_mismatch").get<double>());
  const Json& choice = tradeoff.at("choice");
  if (choice.is_null()) return "The choice: none keeps to the limits, " + kept + ".\n\n";
  return fmt::format("The choice, the cheapest with {}: **{}**, {:.2f} dB.\n\n", kept,
                     choice.at("name").get<std::string>(), choice.at("psnr_db").get<double>());
}

std::string scenes_table(const Json& panel, const Json& scenes) {
  std::vector<std::string> headings{"configuration", "time against the defaults'", "mean dB",
                                    "worst dB, in", "worst mismatch"};
  headings.emplace_back("");
  Table table(headings);
  for (const Json& each : panel.at("configurations")) {
    if (each.at("method") == "tureen --no-specialise") continue;
    if (each.at("settings").size() > 1 && !each.at("on_front").get<bool>()) continue;
    const std::string worst = scenes.at(each.at("worst_scene").get<std::size_t>()).at("label");
    table.line({each.at("name"), number_or_none(each.at("time_ratio"), "{:.3f}"),
                number_or_none(each.at("psnr_db"), "{:.2f}"),
                fmt::format("{:.2f}, {}", each.at("worst_psnr_db").get<double>(), worst),
                number_or_none(each.at("worst_coverage"), "{:.1e}"),
                each.at("on_front").get<bool>() ? "front" : ""});
  }
  return table.text() +
         fmt::format(
             "Means differ by chance by {}; hypervolume {:.1f} decade dB; R1 {:.2f} dB.\n\n",
             percent(panel.at("aa_spread")), panel.at("hypervolume_decade_db").get<double>(),
             panel.at("r1_psnr_db").get<double>());
}

}  // namespace

Section tradeoff_section(const Measurements& measurements, const std::string& name) {
  const Json tradeoff = measurements.json(name, "tradeoff.json");
  const Json &protocol = tradeoff.at("protocol"), &device = tradeoff.at("device");
  Section section{.name = name, .text = head(measurements, {name}), .plots = {}};
  section.text += fmt::format(
      "{}{}; {} views of {}x{} ({}), {} rounds; {}.\n\n", device.at("renderer").get<std::string>(),
      device.at("software").get<bool>() ? ", software" : "", protocol.at("views").get<int>(),
      protocol.at("width").get<int>(), protocol.at("height").get<int>(),
      protocol.at("camera_set").get<std::string>(), protocol.at("rounds").get<int>(),
      protocol.at("clock").get<std::string>());
  section.text += choice_text(tradeoff);
  section.text += panel_table(tradeoff.at("drawing"), true);
  add_plot(section, measurements.file(name, "drawing.svg"), "E_render of drawing knobs");
  section.text += "Antialiasing, against 8 x 8 samples a pixel:\n\n" +
                  panel_table(tradeoff.at("antialiasing"), false);
  add_plot(section, measurements.file(name, "antialiasing.svg"), "E_render of antialiasing knobs");
  section.text += model_table(tradeoff);
  add_plot(section, measurements.file(name, "model.svg"), "E_model");
  return section;
}

Section scenes_section(const Measurements& measurements, const std::string& name) {
  const Json joined = measurements.json(name, "scenes.json");
  Section section{.name = name, .text = head(measurements, {name}), .plots = {}};
  const Json& scenes = joined.at("scenes");
  section.text += fmt::format("{} scenes; what all of them have:\n\n", scenes.size()) +
                  scenes_table(joined.at("drawing"), scenes);
  add_plot(section, measurements.file(name, "means-drawing.svg"), "Means of drawing knobs");
  section.text += "Antialiasing:\n\n" + scenes_table(joined.at("antialiasing"), scenes);
  add_plot(section, measurements.file(name, "means-antialiasing.svg"),
           "Means of antialiasing knobs");
  return section;
}

}  // namespace tureen::test
