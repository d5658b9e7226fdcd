#include "web/engine/commands.hpp"

namespace tureen::web {

Commands bench_commands() { return {}; }

}  // namespace tureen::web
