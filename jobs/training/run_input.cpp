#include "jobs/training/run_input.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "base/input.hpp"
#include "base/json/json_text.hpp"
#include "base/json/json_view.hpp"

namespace tureen {

namespace {

namespace fs = std::filesystem;

constexpr std::array meanings{"background", "mask", "ignore"};  // of AlphaMeaning

fs::path folder_of(const fs::path& log) { return fs::absolute(log).parent_path(); }

DatasetOptions options_of(const JsonView& input) {
  DatasetOptions options;
  options.scale = input["scale"].number();
  if (!(options.scale > 0 && options.scale <= 1)) input["scale"].fail("expected above 0 to 1");
  options.images_folder = int(input["images"].natural(64));
  options.test_every = int(input["test_every"].natural(1'000'000));
  if (options.images_folder < 1 || options.test_every < 2)
    input.fail("images is at least 1, test_every at least 2");
  if (const JsonView alpha = input["alpha"]; !alpha.value().is_null())
    options.alpha = AlphaMeaning(alpha.one_of(meanings));
  options.is_strict = input["strict"].boolean();
  return options;
}

}  // namespace

std::string to_json(const RunInput& input, const fs::path& log) {
  const fs::path path = input.dataset;
  const DatasetOptions& options = input.options;
  Json json{{"dataset", path.is_absolute()
                            ? input.dataset
                            : fs::absolute(path).lexically_proximate(folder_of(log)).string()},
            {"scale", options.scale},
            {"images", options.images_folder},
            {"test_every", options.test_every},
            {"alpha", Json()},
            {"strict", options.is_strict}};
  if (options.alpha) json["alpha"] = meanings[std::size_t(*options.alpha)];
  return json_text(json, -1);
}

std::optional<RunInput> input_of_log(const fs::path& log) {
  std::error_code unknown;
  if (!fs::exists(log, unknown)) return std::nullopt;
  Input file = Input::open(log);
  const std::string text = file.read_text();
  const nlohmann::json document =
      parse_json(std::string_view(text).substr(0, text.find('\n')), file.name());
  const JsonView line(document, file.name());
  const auto plan = line.find("plan");
  const auto input = plan ? plan->find("input") : std::nullopt;
  if (!input || input->value().is_null()) return std::nullopt;
  const fs::path dataset = (*input)["dataset"].text();
  return RunInput{(dataset.is_absolute() ? dataset : folder_of(log) / dataset).lexically_normal(),
                  options_of(*input)};
}

}  // namespace tureen
