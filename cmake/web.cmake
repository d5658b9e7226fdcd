# What a browser build needs beside Emscripten's toolchain: header-only libraries of the machine, and
# the flags that every module shares. Included before any module.

# Debian's headers come after Emscripten's own: found first, /usr/include would give the C library of
# this machine.
add_compile_options("SHELL:-idirafter /usr/include")
add_library(glm::glm INTERFACE IMPORTED)
add_library(nlohmann_json::nlohmann_json INTERFACE IMPORTED)

# WebAssembly's own exceptions: every browser that has had WebGL2 on by default since 2022 knows them,
# and they cost nothing where nothing is thrown.
add_compile_options(-fwasm-exceptions)
add_link_options(-fwasm-exceptions)

# For size: a page is waited for. What a frame costs is the device's, and reading a scene is zlib's and
# ours in loops that -Os leaves as they are.
set(CMAKE_CXX_FLAGS_RELEASE "-Os -DNDEBUG")
