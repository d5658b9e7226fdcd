# The relocatable folder: the program, what it needs beyond glibc beside it, the licence, the README
# and the example; `package` packs it as tureen-VERSION-linux-ARCHITECTURE.tar.gz.
#
# libstdc++ and libgcc are linked statically although folders could hold them: the drivers that we
# load at run time bring their own libstdc++, and an older one of ours, loaded first, would keep
# newer drivers from loading. EGL and OSMesa are never linked, see docs/decisions/portable.md.
target_link_options(tureen PRIVATE -static-libstdc++ -static-libgcc)
set_target_properties(tureen PROPERTIES INSTALL_RPATH "$ORIGIN")

install(TARGETS tureen RUNTIME_DEPENDENCY_SET tureen_libraries RUNTIME DESTINATION .)
# glibc is the one thing that every Linux has and that must match its kernel and its name service.
install(RUNTIME_DEPENDENCY_SET tureen_libraries
  PRE_EXCLUDE_REGEXES "^(lib(c|m|dl|rt|pthread|resolv)\\.so|ld-linux)"
  DESTINATION .)
install(FILES LICENSE README.md DESTINATION .)
install(DIRECTORY examples DESTINATION . FILES_MATCHING PATTERN "*.glb")
# Where ./dev web has made it, what `tureen convert SCENE OUT.html` puts scenes into.
install(FILES "${PROJECT_BINARY_DIR}/share/tureen/scene_template.html" DESTINATION share/tureen
  OPTIONAL)

set(CPACK_GENERATOR TGZ)
set(CPACK_STRIP_FILES ON)
string(TOLOWER "${CMAKE_SYSTEM_NAME}-${CMAKE_SYSTEM_PROCESSOR}" platform)
set(CPACK_PACKAGE_FILE_NAME "tureen-${PROJECT_VERSION}-${platform}")
include(CPack)
