# Settings for a browser build, in addition to Emscripten's toolchain: header-only libraries of the
# system and flags for all modules. Included before any module.

# /usr/include comes after Emscripten's headers; otherwise the host's C library would be found first.
add_compile_options("SHELL:-idirafter /usr/include")
add_library(glm::glm INTERFACE IMPORTED)
add_library(nlohmann_json::nlohmann_json INTERFACE IMPORTED)

# WebAssembly exceptions: browsers with WebGL2 support them since 2022, and they are free unless one
# is thrown.
add_compile_options(-fwasm-exceptions)
add_link_options(-fwasm-exceptions)

# Optimised for size, since the engine is downloaded. em++ disables inlining for -Oz; with it, calls
# of small functions disappear, and the engine is 4 % smaller. The loops that draw are compiled with
# -O2: splatting/CMakeLists.txt. No code asks for a type at run time, which
# saves 4 KB with brotli, or makes statics in two threads.
set(CMAKE_CXX_FLAGS_RELEASE "-Oz -finline-functions -fno-rtti -fno-threadsafe-statics -DNDEBUG")
