#include "web/engine/commands.hpp"

namespace tureen::web {

Commands exchange_commands() { return {}; }

}  // namespace tureen::web
