# The relocatable folder: the program, its shared libraries except glibc, the licence, the README and
# the example. The target `package` packs it as tureen-VERSION-linux-ARCHITECTURE.tar.gz.
#
# libstdc++ and libgcc are linked statically. Graphics drivers load libstdc++ at run time; an older
# copy from the folder, loaded first, would prevent newer drivers from loading. EGL and OSMesa are
# never linked (docs/decisions/portable.md).
target_link_options(tureen PRIVATE -static-libstdc++ -static-libgcc)
set_target_properties(tureen PROPERTIES INSTALL_RPATH "$ORIGIN")

install(TARGETS tureen RUNTIME_DEPENDENCY_SET tureen_libraries RUNTIME DESTINATION .)
# glibc is excluded: every Linux has it, and it must match the kernel and the name service.
install(RUNTIME_DEPENDENCY_SET tureen_libraries
  PRE_EXCLUDE_REGEXES "^(lib(c|m|dl|rt|pthread|resolv)\\.so|ld-linux)"
  DESTINATION .)
install(FILES LICENSE README.md DESTINATION .)
install(DIRECTORY examples DESTINATION . FILES_MATCHING PATTERN "*.glb")
# The template for `tureen convert SCENE OUT.html`, if ./dev web has built it.
install(FILES "${PROJECT_BINARY_DIR}/share/tureen/scene_template.html" DESTINATION share/tureen
  OPTIONAL)

set(CPACK_GENERATOR TGZ)
set(CPACK_STRIP_FILES ON)
string(TOLOWER "${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR}" platform)
set(CPACK_PACKAGE_FILE_NAME "tureen-${PROJECT_VERSION}-${platform}")
include(CPack)
