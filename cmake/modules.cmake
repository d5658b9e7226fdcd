# Checks the arrows between modules (cmake/arrows.cmake) and the limits on size (cmake/limits.cmake)
# before compiling.
file(GLOB_RECURSE checked_sources CONFIGURE_DEPENDS LIST_DIRECTORIES false
  base/*.?pp image/*.?pp scene/*.?pp camera/*.?pp formats/*.?pp oracle/*.?pp splatting/*.?pp tracing/*.?pp
  runtime/*.?pp trainer/*.?pp trainer/*.cu* jobs/*.?pp viewer/*.?pp cli/*.?pp shaders/* web/engine/*.?pp
  web/viewer/* web/common/* web/page/* web/bench/* web/package/* web/report/*)
file(GLOB_RECURSE measured_by_limits CONFIGURE_DEPENDS LIST_DIRECTORIES false
  README.md docs/* cli/* examples/* cmake/* tests/*)
foreach(check arrows limits)
  set(stamp "${PROJECT_BINARY_DIR}/${check}.stamp")
  add_custom_command(
    OUTPUT "${stamp}"
    COMMAND "${CMAKE_COMMAND}" "-DROOT=${PROJECT_SOURCE_DIR}" "-DSTAMP=${stamp}"
            -P "${PROJECT_SOURCE_DIR}/cmake/${check}.cmake"
    DEPENDS "${PROJECT_SOURCE_DIR}/cmake/${check}.cmake" ${checked_sources} ${measured_by_${check}}
    COMMENT "Checking the ${check}"
    VERBATIM)
  add_custom_target(${check} DEPENDS "${stamp}")
endforeach()

# tureen_module(NAME SOURCES .. PUBLIC .. PRIVATE ..): the library tureen_NAME of a folder. Its headers
# include only PUBLIC modules and libraries; its sources also include PRIVATE ones.
function(tureen_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(tureen_${name} STATIC ${ARG_SOURCES})
  add_dependencies(tureen_${name} arrows limits)
  if(name IN_LIST TUREEN_MUTANTS)
    set_target_properties(tureen_${name} PROPERTIES UNITY_BUILD OFF)
  endif()
  target_link_libraries(tureen_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} tureen_warnings)
endfunction()
