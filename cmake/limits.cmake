# Limits on size, each with its reason: what nobody checks grows back. Every build runs:
#   cmake -DROOT=<repository> -DSTAMP=<file> -P cmake/limits.cmake
# An entry is "KIND PATH LIMIT: reason". The first entry that matches a path counts. A limit that says
# "today" is the size on the day of the entry, above the rule that follows it: lower it, never raise it.
#   files  files directly in a folder     lines  lines of a page
#   code   lines of a module's code that are neither blank nor a // comment; a change that adds more
#          raises the limit in the same commit, and its message says what the lines are for
#   bytes  what a browser must fetch before the first image, by brotli; web/build.mjs checks it
cmake_minimum_required(VERSION 3.25)

set(limits
  "files tests/cli 44: today"
  "files tests/fuzz 48: one file per reader"
  "files tests/golden 60: images, not sources"
  "files tests/trainer 51: today"
  "files .* 40: a reader sees a folder at one glance"

  "lines README.md 120: a visitor decides within two screens"
  "lines docs/benchmarks.md 200: headline and one table per subject, git keeps the history"
  "lines docs/format.md 323: today, a specification"
  "lines docs/json.md 175: today"
  "lines docs/numerics.md 184: today"
  "lines docs/training.md 182: today"
  "lines docs/viewer.md 152: today"
  "lines docs/web.md 247: today, and what the page does not read (1), and its paths (1)"
  "lines docs/.* 150: a page is read in ten minutes"

  "code base 2600: fundamentals that no library has, the code for POSIX, bytes in a temporary file (160), and files of killed processes (55)"
  "code image 2732: images, in a file where memory is short, metrics, video files, and the decoder of lossless WebP (560)"
  "code scene 4985: the model, its edits, places and colours as text"
  "code camera 1795: navigation, views around captures, paths along cameras"
  "code formats 17970: a reader per format with its remarks, checked against hostile files; meshes of OBJ with materials and textures (330), palettes in vectors (110), near limits that a file loses, hints for full disks (24), compressed views of glTF (120)"
  "code oracle 2205: the reference stays readable; light along rays, without a tree"
  "code splatting 3160: loops in vectors, per kernel, and of neurons in lanes"
  "code tracing 2240: a tree and a file per kernel, materials, images by rays, also in steps for the window"
  "code shaders 1766: GLSL"
  "code runtime 7970: plan, passes, debug views"
  "code trainer 13625: four methods, CPU and CUDA"
  "code jobs 7995: work that the programs share, the whole of a training run with its forecast, and cameras for photographs; what measures and reports grows no further"
  "code viewer 8725: the window, levels of detail, its gizmo (450), background by name, forecast, search for cameras (45) and clicks by name"
  "code web 9370: the page: its viewer, all formats on demand, files for the user, tours"
  "code cli 7180: the command line computes nothing"
  "code examples 1420: one scene and its dataset"

  "bytes page 415000: 2 s over a connection of 1.7 Mbit/s")

set(wrong "")

# check(KIND PATH SIZE WHAT): adds to `wrong` if SIZE is above the limit.
function(check kind path size what)
  foreach(limit IN LISTS limits)
    if(NOT limit MATCHES "^${kind} ([^ ]+) ([0-9]+): (.*)$")
      continue()
    endif()
    set(pattern "${CMAKE_MATCH_1}")
    set(most "${CMAKE_MATCH_2}")
    set(reason "${CMAKE_MATCH_3}")
    if(path MATCHES "^${pattern}$")
      if(size GREATER most)
        set(wrong "${wrong}\n  ${path} has ${size} ${what}; the limit is ${most} (${reason})" PARENT_SCOPE)
      endif()
      return()
    endif()
  endforeach()
endfunction()

# Folders with sources, without those that a build or npm makes.
file(GLOB_RECURSE paths LIST_DIRECTORIES true RELATIVE "${ROOT}"
  "${ROOT}/base/*" "${ROOT}/image/*" "${ROOT}/scene/*" "${ROOT}/camera/*" "${ROOT}/formats/*"
  "${ROOT}/oracle/*" "${ROOT}/splatting/*" "${ROOT}/tracing/*" "${ROOT}/shaders/*" "${ROOT}/runtime/*" "${ROOT}/trainer/*"
  "${ROOT}/jobs/*" "${ROOT}/viewer/*" "${ROOT}/cli/*" "${ROOT}/examples/*" "${ROOT}/cmake/*"
  "${ROOT}/docs/*" "${ROOT}/tests/*" "${ROOT}/web/engine/*" "${ROOT}/web/viewer/*" "${ROOT}/web/common/*"
  "${ROOT}/web/page/*"
  "${ROOT}/web/bench/*" "${ROOT}/web/report/*")
set(folders "")
foreach(path IN LISTS paths)
  get_filename_component(folder "${path}" DIRECTORY)
  list(APPEND folders "${folder}")
  if(IS_DIRECTORY "${ROOT}/${path}" OR path MATCHES "^tests/" OR
      NOT path MATCHES "\\.(cpp|hpp|cuh?|glsl|vert|frag|comp|ts|m?js|html|css)$")
    continue()
  endif()
  # Lines without blank ones and comments.
  file(READ "${ROOT}/${path}" text)
  string(REGEX REPLACE "\n[ \t]*//[^\n]*" "" text "\n${text}")
  string(REGEX REPLACE "\n[ \t\n]+" "\n" text "${text}")
  string(STRIP "${text}" text)
  string(REGEX MATCHALL "\n" ends "${text}")
  list(LENGTH ends lines)
  math(EXPR lines "${lines} + 1")
  string(REGEX MATCH "^[^/]+" module "${path}")
  if(NOT DEFINED code_${module})
    set(code_${module} 0)
  endif()
  math(EXPR code_${module} "${code_${module}} + ${lines}")
  list(APPEND modules ${module})
endforeach()
list(REMOVE_DUPLICATES modules)
foreach(module IN LISTS modules)
  check(code ${module} ${code_${module}} "lines of code")
endforeach()

list(REMOVE_DUPLICATES folders)
foreach(folder IN LISTS folders)
  file(GLOB entries LIST_DIRECTORIES false "${ROOT}/${folder}/*")
  list(LENGTH entries files)
  check(files ${folder} ${files} files)
endforeach()

file(GLOB_RECURSE pages RELATIVE "${ROOT}" "${ROOT}/README.md" "${ROOT}/docs/*.md")
list(APPEND pages README.md)
foreach(page IN LISTS pages)
  file(READ "${ROOT}/${page}" text)
  string(REGEX MATCHALL "\n" ends "${text}")
  list(LENGTH ends lines)
  check(lines ${page} ${lines} lines)
endforeach()

if(wrong)
  message(FATAL_ERROR "Sizes above the limits in cmake/limits.cmake:${wrong}")
endif()
file(TOUCH "${STAMP}")
