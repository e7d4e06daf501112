# Language, warnings and switches that hold for every target of the project.

option(TALUS_TESTS "Build the tests" ON)
option(TALUS_TESTS_TOGETHER "Compile the sources of tests eight at a time, for machines that build them once; sanitizers do" OFF)
option(TALUS_BENCH "Build the benchmark programs" OFF)
option(TALUS_TIDY "Read every source with clang-tidy, as tests; see TalusTidy" OFF)
set(TALUS_SANITIZE "" CACHE STRING "Sanitizers of this build: empty, address or thread")
set_property(CACHE TALUS_SANITIZE PROPERTY STRINGS "" address thread)

set(CMAKE_CXX_STANDARD 23)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/bin")

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

# talus_compile: what every translation unit of ours is compiled with.
add_library(talus_compile INTERFACE)
target_compile_options(talus_compile INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Werror
  # One world on every processor: a multiply and an add never fuse behind our back.
  -ffp-contract=off
  # Nothing reads errno after a square root; without this each is a call.
  -fno-math-errno)
# SIMD targets of every kernel: the scalar fallback, SSE4, AVX2 and AVX-512, chosen at run time; SSSE3 is older than any
# host. Under a sanitizer AVX2 and the fallback stand for all: they are one source, and a release proves them bit-equal.
if(TALUS_SANITIZE)
  target_compile_definitions(talus_compile INTERFACE "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3|HWY_AVX3_DL)")
else()
  target_compile_definitions(talus_compile INTERFACE HWY_DISABLED_TARGETS=HWY_SSSE3)
endif()
target_include_directories(talus_compile INTERFACE "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>")

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # g++ 12 reports these inside inlined standard library code, where there is nothing to repair.
  target_compile_options(talus_compile INTERFACE
    -Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow -Wno-stringop-overread -Wno-restrict)
endif()

if(TALUS_SANITIZE)
  # Line numbers and a light optimisation: what a report needs, in half the time to build. Assertions stay on.
  set(CMAKE_CXX_FLAGS_RELWITHDEBINFO "-O1 -g1")
endif()
if(TALUS_SANITIZE STREQUAL "address")
  target_compile_options(talus_compile INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(talus_compile INTERFACE -fsanitize=address,undefined)
elseif(TALUS_SANITIZE STREQUAL "thread")
  target_compile_options(talus_compile INTERFACE -fsanitize=thread -Wno-tsan -fno-omit-frame-pointer)
  target_link_options(talus_compile INTERFACE -fsanitize=thread)
endif()
