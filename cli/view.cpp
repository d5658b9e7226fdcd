// `tureen view`: starts the window.
#include "cli/commands.hpp"
#include "cli/files/window_program.hpp"

namespace tureen::cli {

void add_view(Command& program) {
  // All further arguments, including --help, go to the window program.
  program.add_command("view", "Explore a scene in a window").does_with_rest(become_window);
}

}  // namespace tureen::cli
