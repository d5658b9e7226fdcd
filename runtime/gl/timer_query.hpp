// How long the passes of a frame take by the device's own clock: timestamps before and after each,
// read when the device is done, so that nothing waits for them while it draws. Desktop OpenGL has
// them since 3.3; ES where EXT_disjoint_timer_query is (Capabilities::timer_queries).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/gl/context.hpp"
#include "runtime/gl/objects.hpp"

namespace tureen::gl {

struct QueryTraits {
  static GLuint create() {
    GLuint id;
    glGenQueries(1, &id);
    return id;
  }
  static void destroy(GLuint id) { glDeleteQueries(1, &id); }
};
using Query = Object<QueryTraits>;

/// Why the device's timestamps say nothing about its work, as a sentence; nothing where they do.
/// Software renderers gather triangles and draw them when a tile is flushed, whatever pass that
/// falls into.
std::optional<std::string> timers_mislead(const Capabilities& capabilities);

/// Passes between two collect()s. They may not be nested. The context must be current.
class PassTimer {
 public:
  /// Asserts Capabilities::timer_queries.
  explicit PassTimer(const Context& context);

  /// `pass` is a literal: it is kept.
  void begin(const char* pass);
  void end();

  struct PassTime {
    std::string pass;
    double ms = 0;  // all its turns together
    int turns = 0;
  };
  /// Waits for the device. The passes since the last time, in the order of their first turns; empty
  /// where the device says that its clock was disturbed meanwhile (ES).
  std::vector<PassTime> collect();

 private:
  struct Turn {
    const char* pass;
    Query begin, end;
  };
  /// One of those that collect() has read, or a new one.
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

/// Times its scope; nothing without a timer.
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
