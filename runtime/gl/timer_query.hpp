// Times of a frame's passes on the device's clock: timestamps before and after each pass. They are
// read after the frame, so that drawing never waits for them. Desktop OpenGL has them since 3.3, ES
// with EXT_disjoint_timer_query (Capabilities::timer_queries).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/gl/objects.hpp"

namespace tureen::gl {

using Query = Object<NameTraits<glGenQueries, glDeleteQueries>>;

/// The reason why the device's timestamps are misleading, as a sentence, or nullopt. Software
/// renderers queue triangles and draw them when a tile is flushed, possibly during another pass.
std::optional<std::string> timers_mislead(const Capabilities& capabilities);

/// Passes between two calls of collect(). They may not be nested. The context must be current.
class PassTimer {
 public:
  /// Asserts Capabilities::timer_queries.
  explicit PassTimer(const Context& context);

  /// `pass` must be a literal, since the pointer is kept.
  void begin(const char* pass);
  void end();

  struct PassTime {
    std::string pass;
    double ms = 0;  // all occurrences together
    int turns = 0;
  };
  /// The passes since the last call, in the order of their first occurrence. Empty if the device
  /// reports that its clock was disturbed (ES). Waits for the device.
  std::vector<PassTime> collect();

 private:
  struct Turn {
    const char* pass;
    Query begin, end;
  };
  /// A query that collect() has read, or a new one.
  Query take_query();
  void stamp(const Query& query) const;
  double milliseconds(const Turn& turn) const;
  bool disturbed() const;

  using QueryCounter = void (*)(GLuint, GLenum);
  using GetResult = void (*)(GLuint, GLenum, std::uint64_t*);
  QueryCounter query_counter_ = nullptr;
  GetResult get_result_ = nullptr;
  bool may_be_disturbed_ = false;
  std::vector<Turn> turns_;
  std::vector<Query> spare_;
};

/// Times its scope; does nothing without a timer.
class TimedPass {
 public:
  TimedPass(PassTimer* timer, const char* pass) : timer_(timer) {
    if (timer_) timer_->begin(pass);
  }
  TimedPass(const TimedPass&) = delete;
  TimedPass& operator=(const TimedPass&) = delete;
  ~TimedPass() {
    if (timer_) timer_->end();
  }

 private:
  PassTimer* timer_;
};

}  // namespace tureen::gl
