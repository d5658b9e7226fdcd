// Which program this is.
#pragma once

namespace tureen::cli {

/// "0.1.0".
const char* program_version();

/// What `git describe` said of the sources when this was built, with "-dirty" where they differed
/// from the commit; "unknown" outside of git.
const char* program_commit();

/// "release"; "debug" where assertions and queries of OpenGL's errors take time in every frame,
/// "sanitized" where every access to memory does.
const char* program_build();

}  // namespace tureen::cli
