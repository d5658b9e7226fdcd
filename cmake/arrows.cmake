# Checks which module includes headers from which (diagram: ARCHITECTURE.md). A module is a folder in
# the list below. A file belongs to the module with the longest matching path. Every build runs:
#   cmake -DROOT=<repository> -DSTAMP=<file> -P cmake/arrows.cmake
cmake_minimum_required(VERSION 3.25)

# Each line has a module and the modules that it may include; "scene" contains scene/edit.
set(arrows
  "base:"
  "image: base"
  "scene: base image"
  "camera: base image scene"
  "formats: base image scene"
  "oracle: base image scene"
  "splatting: base image scene"
  "shaders:"
  "runtime/gl: base"
  "runtime/plan: base image scene"
  "runtime/passes: base image scene shaders runtime/gl runtime/plan"
  "runtime/splats: base image scene splatting shaders runtime/gl runtime/plan runtime/passes"
  "runtime: base image scene splatting runtime/gl runtime/plan runtime/passes runtime/splats runtime/debug_views"
  "runtime/debug_views: base image scene runtime runtime/gl runtime/plan runtime/passes runtime/splats"
  "trainer/common: base image scene"
  "trainer/diffsoup: base image scene trainer/common trainer/splats"
  "trainer/splats: base image scene splatting trainer/common"
  "jobs/baseline: base image scene runtime runtime/gl runtime/plan runtime/passes runtime/splats"
  "jobs/timing: base image scene runtime runtime/gl"
  "jobs/visibility: base image scene oracle runtime runtime/gl"
  "jobs/bench: base image scene runtime runtime/gl runtime/plan runtime/passes runtime/splats jobs/baseline jobs/timing"
  "jobs/eval: base image scene runtime runtime/gl runtime/plan jobs/baseline"
  "jobs/tradeoff: base image scene oracle splatting runtime runtime/gl runtime/plan runtime/passes jobs/baseline jobs/bench jobs/eval jobs/timing jobs/visibility"
  "jobs/training: base image scene formats runtime/gl jobs/eval trainer/common trainer/diffsoup trainer/splats"
  "jobs/compress: base image scene camera formats runtime runtime/gl jobs/visibility"
  "jobs/report: base"
  "viewer: base image scene camera formats runtime runtime/gl runtime/plan runtime/passes runtime/splats runtime/debug_views trainer/common jobs/baseline jobs/timing"
  "web: base image scene splatting camera formats runtime runtime/gl runtime/plan runtime/splats runtime/debug_views jobs/baseline jobs/timing")

set(modules "")
set(folders "")
foreach(line IN LISTS arrows)
  string(REGEX MATCH "^[^:]+" module "${line}")
  string(REGEX REPLACE "^[^:]+: *" "" allowed "${line}")
  string(REPLACE " " ";" allowed "${allowed}")
  list(APPEND modules ${module})
  string(REGEX MATCH "^[^/]+" folder "${module}")
  list(APPEND folders ${folder})
  set(allowed_${module} ${allowed})
endforeach()
list(REMOVE_DUPLICATES folders)
# In descending order, so that runtime/gl is found before runtime.
list(SORT modules ORDER DESCENDING)

# module_of(PATH OUT): sets OUT to the module of PATH, or to "".
function(module_of path out)
  foreach(module IN LISTS modules)
    string(FIND "${path}" "${module}/" at)
    if(at EQUAL 0)
      set(${out} ${module} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  set(${out} "" PARENT_SCOPE)
endfunction()

set(wrong "")
foreach(folder IN LISTS folders)
  file(GLOB_RECURSE sources RELATIVE "${ROOT}"
    "${ROOT}/${folder}/*.hpp" "${ROOT}/${folder}/*.cpp" "${ROOT}/${folder}/*.cu*")
  foreach(source IN LISTS sources)
    module_of(${source} from)
    file(STRINGS "${ROOT}/${source}" lines REGEX "^#include \"")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE "^#include \"([^\"]*)\".*" "\\1" header "${line}")
      module_of(${header} to)
      if(NOT EXISTS "${ROOT}/${header}" OR to STREQUAL from OR to IN_LIST allowed_${from})
        continue()
      endif()
      list(JOIN allowed_${from} ", " allowed)
      string(APPEND wrong "\n  ${source} includes ${header}; ${from}/ may include ${allowed}")
    endforeach()
  endforeach()
endforeach()
if(wrong)
  message(FATAL_ERROR "Arrows between modules that cmake/arrows.cmake does not list:${wrong}")
endif()
file(TOUCH "${STAMP}")
