# The CUDA backend: two files. With AUTO it is built if nvcc is found; ON makes a missing nvcc an
# error.
set(TUREEN_CUDA AUTO CACHE STRING "Build the CUDA backend of the trainer: AUTO, ON or OFF")
set_property(CACHE TUREEN_CUDA PROPERTY STRINGS AUTO ON OFF)
set(TUREEN_HAS_CUDA OFF)
if(TUREEN_CUDA)
  include(CheckLanguage)
  if(NOT CMAKE_CUDA_COMPILER AND EXISTS /usr/local/cuda/bin/nvcc)
    set(CMAKE_CUDA_COMPILER /usr/local/cuda/bin/nvcc)  # the default location, rarely on the path
  endif()
  # Sanitizers are incompatible with nvcc's own pass over host code.
  if(NOT TUREEN_SANITIZE)
    check_language(CUDA)
  endif()
  if(CMAKE_CUDA_COMPILER)
    # Ampere, Hopper, and Blackwell's desktop cards and later. They are listed because the build
    # machine may have no GPU.
    if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
      set(CMAKE_CUDA_ARCHITECTURES 80-real 90-real 120)
    endif()
    enable_language(CUDA)
    set(TUREEN_HAS_CUDA ON)
  elseif(NOT TUREEN_CUDA STREQUAL AUTO)
    message(FATAL_ERROR "TUREEN_CUDA is ON, and nvcc was not found")
  endif()
endif()

if(TUREEN_HAS_CUDA)
  message(STATUS "The trainer has a CUDA backend: ${CMAKE_CUDA_COMPILER}")
  if(CCACHE)
    set(CMAKE_CUDA_COMPILER_LAUNCHER "${CCACHE}")
  endif()
  add_library(tureen_cuda OBJECT common/cuda/cuda_machine.cu diffsoup/cuda/cuda_backend.cu)
  target_include_directories(tureen_cuda PRIVATE
    $<TARGET_PROPERTY:tureen_trainer,INTERFACE_INCLUDE_DIRECTORIES>)
  # CMake 3.25 does not support CUDA standard 20. Warning 20012: glm marks defaulted functions for
  # the device.
  set_target_properties(tureen_cuda PROPERTIES CUDA_STANDARD_REQUIRED OFF CUDA_RUNTIME_LIBRARY Static)
  target_compile_options(tureen_cuda PRIVATE -std=c++20 --expt-relaxed-constexpr -O3
    -diag-suppress=20012 -Xcompiler=-Wall,-Wextra,-Wno-psabi)
  if(TUREEN_WERROR)
    target_compile_options(tureen_cuda PRIVATE -Werror=all-warnings,cross-execution-space-call)
  endif()
  target_sources(tureen_trainer PRIVATE $<TARGET_OBJECTS:tureen_cuda>)
  target_compile_definitions(tureen_trainer PRIVATE TUREEN_HAS_CUDA)
  find_package(CUDAToolkit REQUIRED)
  target_link_libraries(tureen_trainer PRIVATE CUDA::cudart_static)
endif()
