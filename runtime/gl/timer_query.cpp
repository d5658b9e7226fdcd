#include "runtime/gl/timer_query.hpp"

#include <algorithm>
#include <cassert>

namespace tureen::gl {

namespace {

// EXT_disjoint_timer_query has the same values under other names.
constexpr GLenum timestamp = 0x8E28, query_result = 0x8866, gpu_disjoint = 0x8FBB;

}  // namespace

std::optional<std::string> timers_mislead(const Capabilities& capabilities) {
  if (capabilities.software)
    return "software OpenGL (" + capabilities.renderer +
           ") draws when its tiles are flushed, possibly during another pass: only the "
           "processor's clock is used";
  if (!capabilities.timer_queries)
    return "this context has no timer queries: only the processor's clock is used";
  return {};
}

PassTimer::PassTimer(const Context& context) {
  assert(context.capabilities().timer_queries);
  const bool desktop = context.capabilities().api == Api::desktop;
  const auto get = context.get_proc_address();
  query_counter_ =
      reinterpret_cast<QueryCounter>(get(desktop ? "glQueryCounter" : "glQueryCounterEXT"));
  get_result_ = reinterpret_cast<GetResult>(
      get(desktop ? "glGetQueryObjectui64v" : "glGetQueryObjectui64vEXT"));
  may_be_disturbed_ = !desktop;
  if (may_be_disturbed_) disturbed();  // reading clears earlier disturbances
}

Query PassTimer::take_query() {
  if (spare_.empty()) return Query::create();
  Query query = std::move(spare_.back());
  spare_.pop_back();
  return query;
}

void PassTimer::stamp(const Query& query) const { query_counter_(query.id(), timestamp); }

void PassTimer::begin(const char* pass) {
  turns_.push_back({pass, take_query(), {}});
  stamp(turns_.back().begin);
}

void PassTimer::end() {
  assert(!turns_.empty() && !turns_.back().end);
  turns_.back().end = take_query();
  stamp(turns_.back().end);
}

double PassTimer::milliseconds(const Turn& turn) const {
  std::uint64_t begin = 0, end = 0;  // nanoseconds
  get_result_(turn.begin.id(), query_result, &begin);
  get_result_(turn.end.id(), query_result, &end);
  return end > begin ? double(end - begin) / 1e6 : 0;
}

bool PassTimer::disturbed() const {
  GLint value = 0;
  if (may_be_disturbed_) glGetIntegerv(gpu_disjoint, &value);
  return value != 0;
}

std::vector<PassTimer::PassTime> PassTimer::collect() {
  std::vector<PassTime> result;
  for (Turn& turn : turns_) {
    auto found = std::find_if(result.begin(), result.end(),
                              [&](const PassTime& each) { return each.pass == turn.pass; });
    if (found == result.end()) found = result.insert(result.end(), PassTime{turn.pass, 0, 0});
    found->ms += milliseconds(turn);
    ++found->turns;
    spare_.push_back(std::move(turn.begin));
    spare_.push_back(std::move(turn.end));
  }
  turns_.clear();
  if (disturbed()) result.clear();
  return result;
}

}  // namespace tureen::gl
