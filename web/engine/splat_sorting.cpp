#include "web/engine/splat_sorting.hpp"

#include <utility>

#include "web/engine/archive.hpp"
#include "web/engine/engine.hpp"

namespace tureen::web {

namespace {

// -- the instance in the page ---------------------------------------------------------------------

class PageSplatSorter final : public SplatSorter {
 public:
  explicit PageSplatSorter(SplatSorting& sorting) : sorting_(sorting) {}
  ~PageSplatSorter() override { forget(); }
  void begin(std::vector<SplatsInView> views) override {
    sorting_.current.emplace().views = std::move(views);
    ++sorting_.number;
  }
  bool take(SplatOrder& order) override {
    std::optional<SortTask>& task = sorting_.current;
    if (!task || !task->order) return false;
    order = std::move(*task->order);
    task.reset();
    return true;
  }
  void forget() override {
    sorting_.current.reset();
    sorting_.sent_centers = false;  // the next task may have others
  }

 private:
  SplatSorting& sorting_;
};

/// Returns the next task, {"number", "layers": [{"axis", "offset", "behind"}]}, or null. Writes the
/// centres to the buffer; nothing if the worker has them.
Json sort_task(Engine& engine, const Json&) {
  SplatSorting& all = engine.sorting;
  if (!all.current || all.current->sent) return nullptr;
  Json layers = Json::array();
  ArchiveWriter centers;
  for (const SplatsInView& view : all.current->views) {
    layers.push_back(
        object({{"axis", to_json(view.axis)}, {"offset", view.offset}, {"behind", view.behind}}));
    if (!all.sent_centers) centers(view.centers);
  }
  engine.buffer = centers.take();
  all.current->sent = all.sent_centers = true;
  return object({{"number", all.number}, {"layers", layers}});
}

/// number of the task: the buffer holds its order. Returns whether the task is current.
Json sorted(Engine& engine, const Json& number) {
  SplatSorting& all = engine.sorting;
  if (!all.current || number != all.number) return false;
  std::vector<std::uint32_t> splats;
  std::vector<SplatRun> runs;
  ArchiveReader archive(engine.buffer);
  archive(splats, runs);
  all.current->order.emplace(std::move(splats), std::move(runs));
  return true;
}

// -- the instance in the worker -------------------------------------------------------------------

/// {"layers"} of a task. The buffer has the centres; it is empty if they are those of the last
/// task. Writes the order to the buffer.
void sort(Engine& engine, const Json& task) {
  auto& centers = engine.sorting.centers;
  SplatOrder& order = engine.sorting.order;
  const Json& layers = task.at("layers");
  if (!engine.buffer.empty()) {
    centers.assign(layers.size(), {});
    ArchiveReader archive(engine.buffer);
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
  engine.buffer = archive.take();
}

}  // namespace

std::unique_ptr<SplatSorter> make_page_sorter(SplatSorting& sorting) {
  return std::make_unique<PageSplatSorter>(sorting);
}

Commands sorting_commands() {
  return {{"sort_task", sort_task}, {"sorted", sorted}, {"sort", does(sort)}};
}

}  // namespace tureen::web
