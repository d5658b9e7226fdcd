// A session of the window.
#include "viewer/files/session.hpp"

#include "tests/fuzz/scratch.hpp"

namespace tureen::fuzz {

void session(Bytes bytes) {
  static const Scratch scratch("session");
  scratch.write("session.json", bytes);
  viewer::session_to_json(viewer::read_session(scratch.folder() / "session.json"));
}

}  // namespace tureen::fuzz
