// The version and build of the program.
#pragma once

namespace tureen::cli {

/// "0.1.0".
const char* program_version();

/// The output of `git describe` at build time, with "-dirty" if the sources differed from the
/// commit; "unknown" without git.
const char* program_commit();

/// "release"; "debug" if assertions and queries of OpenGL errors slow down every frame; "sanitized"
/// if checks slow down every memory access.
const char* program_build();

}  // namespace tureen::cli
