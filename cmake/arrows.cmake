# Checks which module includes files of which (diagram: ARCHITECTURE.md): C++ headers, GLSL includes
# and imports of TypeScript and JavaScript. Every build runs:
#   cmake -DROOT=<repository> -DSTAMP=<file> -P cmake/arrows.cmake
cmake_minimum_required(VERSION 3.25)

# Each line has the paths of a module, and the modules that it may include, which stand on earlier
# lines: so there are no circles. A path is a folder, a file, or a file with any extension. A file
# belongs to the module with the longest matching path; "scene" contains scene/edit. The name of a
# module is its first path; "formats/*" means formats and all modules in it.
set(arrows
  "base:"
  "image: base"
  "scene: base image"
  "camera: base image scene"

  "formats/read_options.hpp: scene"
  "formats/common: base scene formats/read_options.hpp"
  "formats/archive: base formats/common"
  "formats/glb: base image scene formats/common"
  "formats/ply: base formats/read_options.hpp formats/common"
  "formats/dataset: base image scene formats/read_options.hpp formats/common formats/ply"
  "formats/diffsoup: base image scene formats/read_options.hpp formats/common formats/ply"
  "formats/gltf: base image scene formats/read_options.hpp formats/common formats/glb"
  "formats/mesh: base image scene formats/read_options.hpp formats/common formats/ply"
  # Every reader of splats builds them by it, every writer begins with it.
  "formats/splat/splat_builder.* formats/splat/splat_writing.* formats/splat/splat_remarks.hpp: base scene formats/read_options.hpp formats/common"
  "formats/sog: base image scene formats/read_options.hpp formats/common formats/archive formats/splat/splat_builder.*"
  "formats/splat: base image scene formats/read_options.hpp formats/common formats/archive formats/ply formats/splat/splat_builder.*"
  "formats/torch: base image scene formats/read_options.hpp formats/common formats/archive"
  "formats/tureen_glb: base image scene formats/read_options.hpp formats/common formats/glb"
  "formats/usd: base scene formats/read_options.hpp formats/common formats/archive formats/splat/splat_builder.*"
  "formats: base image scene formats/*"

  "oracle: base image scene"

  "splatting/tiles/tile_lists.*: base scene"
  "splatting: base image scene splatting/tiles/tile_lists.*"
  "splatting/tiles: base image scene splatting splatting/tiles/tile_lists.*"
  "splatting/gaussians: scene splatting splatting/tiles splatting/tiles/tile_lists.*"
  # To go: discs use the Gaussians' rows of harmonics.
  "splatting/discs: scene splatting splatting/tiles splatting/tiles/tile_lists.* splatting/gaussians"
  "splatting/neural: scene splatting splatting/tiles splatting/tiles/tile_lists.*"
  "splatting/windows: scene splatting splatting/tiles splatting/tiles/tile_lists.*"
  "splatting/kernel_rows.cpp splatting/layer.cpp: base scene splatting/*"

  "tracing: base image scene splatting/*"

  "shaders:"
  "shaders/splats: shaders"
  "shaders/debug_views: shaders"

  "runtime/gl: base"
  "runtime/plan: base image scene splatting"
  "runtime/passes: base image scene shaders runtime/gl runtime/plan"
  "runtime/splats: base image scene splatting/* shaders runtime/gl runtime/plan runtime/passes"
  "runtime: base image scene splatting/* runtime/gl runtime/plan runtime/passes runtime/splats"
  "runtime/debug_views: base image scene runtime/*"

  "trainer/common: base image scene"
  "trainer/splats: base scene splatting/* trainer/common"
  "trainer/splats/gaussians: base scene splatting/* trainer/common trainer/splats"
  # To go: discs are stepped as Gaussians.
  "trainer/splats/discs: base scene splatting/* trainer/common trainer/splats trainer/splats/gaussians"
  "trainer/splats/neural: base scene splatting/* trainer/common trainer/splats"
  "trainer/splats/windows: base scene splatting/* trainer/common trainer/splats"
  # A state and its trainer know all kernels; the methods of training derive from the trainer.
  "trainer/splats/splat_state.* trainer/splats/splat_start.hpp trainer/splats/splat_initialise.hpp trainer/splats/splat_trainer.*: base scene splatting/* trainer/common trainer/splats/*"
  "trainer/splats/gaussians/gaussian_training.* trainer/splats/neural/neural_training.* trainer/splats/windows/window_training.*: base scene splatting/* trainer/common trainer/splats/*"
  "trainer/splats/splat_initialise.cpp trainer/splats/splat_forecast.* trainer/splats/splat_training.*: base scene splatting/* trainer/common trainer/splats/*"
  "trainer/diffsoup: base image scene trainer/common"
  "jobs/baseline: base image scene runtime runtime/gl runtime/plan runtime/passes runtime/splats"
  "jobs/timing: base image scene runtime runtime/gl"
  "jobs/visibility: base image scene oracle splatting/* runtime runtime/gl runtime/passes"
  "jobs/bench: base image scene runtime runtime/gl runtime/plan runtime/passes runtime/splats jobs/baseline jobs/timing"
  "jobs/eval: base image scene runtime runtime/gl runtime/plan jobs/baseline"
  "jobs/tradeoff: base image scene oracle splatting/* tracing runtime runtime/gl runtime/plan runtime/passes jobs/baseline jobs/bench jobs/eval jobs/timing jobs/visibility"
  "jobs/cameras: base image scene formats/*"
  "jobs/compress: base image scene camera formats/* runtime runtime/gl jobs/visibility"
  "jobs/conversion: image scene camera runtime/splats"
  "jobs/report: base"
  "jobs/training: base image scene formats formats/dataset runtime/gl jobs/eval trainer/*"

  "viewer/input: base scene camera"
  "viewer/gui: base image scene runtime/gl runtime/passes viewer/input"
  "viewer/files: base scene formats/* jobs/cameras trainer/common viewer/input viewer/gui"
  "viewer: base image scene camera formats/* tracing runtime/* trainer/common jobs/baseline jobs/cameras jobs/timing jobs/training viewer/*"
  "viewer/panels: base image scene camera formats/* runtime/plan trainer/common jobs/timing jobs/training viewer viewer/files viewer/gui viewer/input"

  "web/engine: base image scene splatting/* camera formats/* runtime runtime/gl runtime/plan runtime/splats runtime/debug_views jobs/baseline jobs/timing"
  "web/viewer:"
  "web/package: web/viewer"
  "web/common: web/viewer"
  "web/page: web/viewer web/common"
  "web/page/sections: web/viewer web/common web/page"
  "web/page/viewer_page.ts web/page/page.ts web/page/single_file.ts: web/viewer web/common web/page web/page/sections"
  "web/bench: web/viewer web/common"
  "web/report:"

  "cli/exit_code.hpp cli/interrupt.* cli/progress.* cli/report.* cli/table.* cli/version.*: base scene"
  "cli/options: base image scene camera oracle tracing formats/* runtime/* jobs/* cli/exit_code.hpp"
  "cli/files: base image scene formats/* runtime/* trainer/common jobs/* cli/exit_code.hpp cli/options"
  "cli/measuring: base scene camera runtime/gl jobs/* cli/exit_code.hpp cli/options"
  "cli/bench: base scene jobs/* cli/exit_code.hpp cli/options cli/files cli/measuring"
  "cli/tradeoff: base scene camera formats/* runtime/gl jobs/* cli/exit_code.hpp cli/options cli/files cli/measuring"
  "cli: base image scene camera formats/* oracle splatting/* tracing runtime/* trainer/* jobs/* cli/*")

set(wrong "")
set(modules "")
set(folders "")
foreach(line IN LISTS arrows)
  string(REGEX MATCH "^([^:]+): *(.*)$" line "${line}")
  string(REPLACE " " ";" paths "${CMAKE_MATCH_1}")
  string(REPLACE " " ";" names "${CMAKE_MATCH_2}")
  list(GET paths 0 module)
  set(allowed_${module} "")
  foreach(name IN LISTS names)
    set(meant ${name})
    if(name MATCHES "^(.*)/[*]$")
      set(meant ${modules})
      list(FILTER meant INCLUDE REGEX "^${CMAKE_MATCH_1}(/|$)")
    elseif(NOT name IN_LIST modules)
      string(APPEND wrong "\n  ${module} names ${name}, which stands on no earlier line")
    endif()
    list(APPEND allowed_${module} ${meant})
  endforeach()
  list(APPEND modules ${module})
  foreach(path IN LISTS paths)
    set(module_at_${path} ${module})
    string(REGEX MATCH "^(web/)?[^/]+" folder "${path}")
    list(APPEND folders ${folder})
  endforeach()
endforeach()
list(REMOVE_DUPLICATES folders)

# module_of(PATH OUT): sets OUT to the module of PATH, or to "".
function(module_of path out)
  string(REGEX REPLACE "[.][^/.]*$" ".*" any "${path}")
  if(NOT DEFINED module_at_${path} AND DEFINED module_at_${any})
    set(path "${any}")
  endif()
  while(NOT DEFINED module_at_${path} AND path MATCHES "^(.*)/[^/]*$")
    set(path "${CMAKE_MATCH_1}")
  endwhile()
  set(${out} "${module_at_${path}}" PARENT_SCOPE)
endfunction()

# check(SOURCE FILE): adds to `wrong` unless SOURCE may include FILE.
function(check source file)
  module_of(${source} from)
  module_of(${file} to)
  if(NOT to STREQUAL from AND NOT to IN_LIST allowed_${from})
    list(JOIN allowed_${from} ", " allowed)
    set(wrong "${wrong}\n  ${source} includes ${file}; ${from} may include ${allowed}" PARENT_SCOPE)
  endif()
endfunction()

set(sources "")
foreach(folder IN LISTS folders)
  foreach(kind hpp cpp cu* glsl frag vert comp ts js mjs)
    file(GLOB_RECURSE found RELATIVE "${ROOT}" "${ROOT}/${folder}/*.${kind}")
    list(APPEND sources ${found})
  endforeach()
endforeach()
list(FILTER sources EXCLUDE REGEX "/node_modules/")
set(scripts ${sources})
list(FILTER scripts INCLUDE REGEX "[.](ts|js|mjs)$")
set(shaders ${sources})
list(FILTER shaders INCLUDE REGEX "[.](glsl|frag|vert|comp)$")
foreach(source IN LISTS shaders)
  get_filename_component(name ${source} NAME)
  set(shader_${name} ${source})
endforeach()

foreach(source IN LISTS sources)
  if(source IN_LIST scripts)
    file(READ "${ROOT}/${source}" text)
    string(REGEX MATCHALL "(from |import |import\\()'\\.[^']*'" lines "${text}")
  else()
    file(STRINGS "${ROOT}/${source}" lines REGEX "^#include [\"<]")
  endif()
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^[^\"<']*[\"<']([^\">']*).*" "\\1" file "${line}")
    if(line MATCHES "<" AND file MATCHES "^(sys/.*|dlfcn|fcntl|poll|spawn|unistd)[.]h$")
      if(NOT source MATCHES "^base/platform/")
        string(APPEND wrong "\n  ${source} includes <${file}>; only base/platform/ may")
      endif()
    elseif(DEFINED shader_${file})  # a shader includes others by their names
      set(file ${shader_${file}})
    elseif(source IN_LIST scripts)  # an import names the script that TypeScript's compiler makes of a file
      get_filename_component(folder ${source} DIRECTORY)
      get_filename_component(file "${folder}/${file}" ABSOLUTE BASE_DIR "/")
      string(REGEX REPLACE "^/" "" file "${file}")
      string(REGEX REPLACE "[.]js$" ".ts" typed "${file}")
      if(EXISTS "${ROOT}/${typed}")
        set(file ${typed})
      endif()
    endif()
    if(EXISTS "${ROOT}/${file}")
      check(${source} ${file})
      list(APPEND included_${source} ${file})
    endif()
  endforeach()
endforeach()

# Circles of shaders or scripts: what remains after all files are removed that include no remaining
# file, or that none includes.
set(left "${shaders};${scripts}")
set(before "")
while(NOT left STREQUAL before)
  set(before "${left}")
  foreach(source IN LISTS before)
    set(gone "${included_${source}}")
    list(REMOVE_ITEM gone ${left})
    if(gone STREQUAL "${included_${source}}")
      list(REMOVE_ITEM left ${source})
    endif()
  endforeach()
  set(used "")
  foreach(source IN LISTS left)
    list(APPEND used ${included_${source}})
  endforeach()
  foreach(source IN LISTS before)
    if(NOT source IN_LIST used)
      list(REMOVE_ITEM left ${source})
    endif()
  endforeach()
endwhile()
if(left)
  list(JOIN left ", " left)
  string(APPEND wrong "\n  these include each other in a circle: ${left}")
endif()

if(wrong)
  message(FATAL_ERROR "Arrows between modules that cmake/arrows.cmake does not list:${wrong}")
endif()
file(TOUCH "${STAMP}")
