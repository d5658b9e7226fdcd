#include "web/engine/splat_sorting.hpp"

#include <optional>
#include <utility>

#include "web/engine/archive.hpp"

namespace tureen::web {

namespace {

// -- the instance in the page ---------------------------------------------------------------------

struct SortTask {
  std::vector<SplatsInView> views;
  bool sent = false;
  std::optional<SplatOrder> order;
};

struct SortTasks {
  std::optional<SortTask> current;
  int number = 0;             // of the current task
  bool sent_centers = false;  // whether the worker has the centres of the current task
};

SortTasks& tasks() {
  static SortTasks all;
  return all;
}

class PageSplatSorter final : public SplatSorter {
 public:
  ~PageSplatSorter() override { forget(); }
  void begin(std::vector<SplatsInView> views) override {
    tasks().current.emplace().views = std::move(views);
    ++tasks().number;
  }
  bool take(SplatOrder& order) override {
    std::optional<SortTask>& task = tasks().current;
    if (!task || !task->order) return false;
    order = std::move(*task->order);
    task.reset();
    return true;
  }
  void forget() override {
    tasks().current.reset();
    tasks().sent_centers = false;  // the next task may have others
  }
};

/// Returns the next task, {"number", "layers": [{"axis", "offset", "behind"}]}, or null. Writes the
/// centres to the buffer; nothing if the worker has them.
Json sort_task(const Json&) {
  SortTasks& all = tasks();
  if (!all.current || all.current->sent) return nullptr;
  Json layers = Json::array();
  ArchiveWriter centers;
  for (const SplatsInView& view : all.current->views) {
    layers.push_back(
        object({{"axis", to_json(view.axis)}, {"offset", view.offset}, {"behind", view.behind}}));
    if (!all.sent_centers) centers(view.centers);
  }
  buffer() = centers.take();
  all.current->sent = all.sent_centers = true;
  return object({{"number", all.number}, {"layers", layers}});
}

/// number of the task: the buffer holds its order. Returns whether the task is current.
Json sorted(const Json& number) {
  SortTasks& all = tasks();
  if (!all.current || number != all.number) return false;
  std::vector<std::uint32_t> splats;
  std::vector<SplatRun> runs;
  ArchiveReader archive(buffer());
  archive(splats, runs);
  all.current->order.emplace(std::move(splats), std::move(runs));
  return true;
}

// -- the instance in the worker -------------------------------------------------------------------

/// {"layers"} of a task. The buffer has the centres; it is empty if they are those of the last
/// task. Writes the order to the buffer.
void sort(const Json& task) {
  static std::vector<std::vector<glm::vec3>> centers;
  static SplatOrder order;
  const Json& layers = task.at("layers");
  if (!buffer().empty()) {
    centers.assign(layers.size(), {});
    ArchiveReader archive(buffer());
    for (std::vector<glm::vec3>& each : centers) archive(each);
  }
  std::vector<SplatsInView> views;
  for (std::size_t i = 0; i < layers.size(); ++i)
    views.push_back({.centers = centers.at(i),
                     .axis = vector_of(layers[i].at("axis")),
                     .offset = layers[i].at("offset"),
                     .behind = layers[i].at("behind").get<std::vector<bool>>()});
  order.sort(views);
  ArchiveWriter archive;
  archive(order.splats(), order.runs());
  buffer() = archive.take();
}

}  // namespace

std::unique_ptr<SplatSorter> make_page_sorter() { return std::make_unique<PageSplatSorter>(); }

Commands sorting_commands() {
  return {{"sort_task", sort_task}, {"sorted", sorted}, {"sort", does(sort)}};
}

}  // namespace tureen::web
