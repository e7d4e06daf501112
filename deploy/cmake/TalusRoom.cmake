# talus_sanitize_kernel(SOURCE): most of a run under a sanitizer is the world's evaluation. Highway's functions are inlined,
# and each of their thousands of temporaries would be marked in shadow memory when its life begins and ends: two thirds of a
# kernel's time. And a kernel that keeps nothing itself reads and writes what is its caller's, whose own accesses the thread
# sanitizer sees.
function(talus_sanitize_kernel source)
  if(TALUS_SANITIZE STREQUAL "address")
    set_property(SOURCE "${source}" APPEND PROPERTY COMPILE_OPTIONS -fno-sanitize-address-use-after-scope)
  elseif(TALUS_SANITIZE STREQUAL "thread")
    file(STRINGS "${source}" keeps REGEX "vector<|_back\\(" LIMIT_COUNT 1)
    if(NOT keeps)
      set_property(SOURCE "${source}" APPEND PROPERTY COMPILE_OPTIONS -fno-sanitize=thread)
    endif()
  endif()
endfunction()

# talus_read_together(TARGET): its sources are compiled eight at a time, which reads the headers of the standard library
# and Asio once for all of them: half the time, where nobody changes one source and builds again. Kernels stay alone:
# Highway compiles each several times over.
function(talus_read_together target)
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source)
    file(STRINGS "${source}" kernel REGEX "HWY_TARGET_INCLUDE" LIMIT_COUNT 1)
    if(kernel)
      set_source_files_properties("${source}" PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
      talus_sanitize_kernel("${source}")
    endif()
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  # Read from within another file, a source looks like a header to the compiler: no type of one should hide a member's.
  target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
endfunction()

# talus_room(NAME [PUBLIC lib...] [PRIVATE lib...]): one folder of the house becomes one static library of all its *.cpp.
# A room sees only what it links; tests/unit/house/include_order_test.cpp holds the same order for #include lines.
function(talus_room name)
  cmake_parse_arguments(ROOM "" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  add_library(${name} STATIC ${sources})
  target_link_libraries(${name} PUBLIC ${ROOM_PUBLIC} PRIVATE talus_compile ${ROOM_PRIVATE})
  file(RELATIVE_PATH folder "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
  if(TALUS_SANITIZE)
    talus_read_together(${name})
    # Who waits and decides takes little of the time; it is compiled in two thirds of its own without being optimised, and
    # every access that the source makes is checked. The world itself and its coding are the run.
    if(NOT folder MATCHES "^(core/|protocol$)")
      target_compile_options(${name} PRIVATE -O0)
    endif()
  endif()
  # What an engine may link; TalusInstall installs it.
  if(folder MATCHES "^(core/|protocol$|client_sample/library$)")
    set_property(GLOBAL APPEND PROPERTY TALUS_INSTALLED_ROOMS ${name})
  endif()
endfunction()
