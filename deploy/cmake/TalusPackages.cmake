# Third-party packages, all from Debian 12; their headers are SYSTEM so that our warnings stay ours.
# `deploy/packages` lists what has to be installed for these to be found.

find_package(Threads REQUIRED)
find_package(glm REQUIRED)
find_package(hwy REQUIRED)
find_package(draco REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(PNG REQUIRED)
find_package(zstd REQUIRED)
find_package(FlatBuffers REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(prometheus-cpp REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS SSL Crypto)
find_package(SQLite3 REQUIRED)
find_package(wslay REQUIRED)
find_path(TALUS_ASIO_INCLUDE asio.hpp REQUIRED)
find_path(TALUS_LLHTTP_INCLUDE llhttp.h PATHS /usr/share/include PATH_SUFFIXES llhttp REQUIRED)
find_path(TALUS_LLHTTP_SOURCES llhttp.c PATHS /usr/share PATH_SUFFIXES llhttp REQUIRED)
find_path(TALUS_JWT_INCLUDE jwt.h REQUIRED)
find_library(TALUS_JWT_LIBRARY jwt REQUIRED)
find_program(TALUS_FLATC flatc REQUIRED)

add_library(talus_asio INTERFACE)
target_include_directories(talus_asio SYSTEM INTERFACE "${TALUS_ASIO_INCLUDE}")
# Asio 1.22 finds out about aligned_alloc by which header was read before it, so that one source would allocate with it and
# another free what operator new gave.
target_compile_definitions(talus_asio INTERFACE ASIO_STANDALONE ASIO_NO_DEPRECATED ASIO_HAS_STD_ALIGNED_ALLOC=1)
target_link_libraries(talus_asio INTERFACE Threads::Threads)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Asio's coroutine frames are allocated and freed by its own pair of functions; with sanitizers g++ 12 inlines one only.
  target_compile_options(talus_asio INTERFACE -Wno-mismatched-new-delete)
endif()

# Debian has llhttp as sources (node-llhttp). Strict: what it would forgive is what smuggling lives on.
add_library(talus_llhttp STATIC "${TALUS_LLHTTP_SOURCES}/llhttp.c" "${TALUS_LLHTTP_SOURCES}/api.c" "${TALUS_LLHTTP_SOURCES}/http.c")
target_include_directories(talus_llhttp SYSTEM PUBLIC "$<BUILD_INTERFACE:${TALUS_LLHTTP_INCLUDE}>")
target_compile_definitions(talus_llhttp PRIVATE LLHTTP_STRICT_MODE=1)
target_compile_options(talus_llhttp PRIVATE -O2)

add_library(talus_jwt INTERFACE)
target_include_directories(talus_jwt SYSTEM INTERFACE "${TALUS_JWT_INCLUDE}")
target_link_libraries(talus_jwt INTERFACE "${TALUS_JWT_LIBRARY}")
