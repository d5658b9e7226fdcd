// Which program this is.
#pragma once

namespace tureen::cli {

/// "0.1.0".
const char* program_version();

/// What `git describe` said of the sources when this was built, with "-dirty" where they differed
/// from the commit; "unknown" outside of git.
const char* program_commit();

}  // namespace tureen::cli
