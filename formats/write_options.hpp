// Options of all writers. A writer applies those that concern its format.
#pragma once

namespace tureen {

struct WriteOptions {
  int spz_version = 4;  // or 3, for programs that do not know 4
};

}  // namespace tureen
