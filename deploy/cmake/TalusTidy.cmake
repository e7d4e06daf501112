# The preset `tidy`: clang-tidy reads, nothing is compiled. Nearly all of its time goes into the headers of the standard
# library, Asio and Highway, which it reads and searches again for every source: so a room's sources are read as one unit
# (CMake's unity sources), its headers once. Every unit is a test of CTest, named by its folder.
if(NOT TALUS_TIDY)
  return()
endif()
find_program(TALUS_CLANG_TIDY NAMES clang-tidy-14 REQUIRED)
file(STRINGS "${PROJECT_SOURCE_DIR}/tests/tidy/arguments" arguments)

function(talus_tidy_units folder)
  get_property(targets DIRECTORY "${folder}" PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target IN LISTS targets)
    get_target_property(kind ${target} TYPE)
    if(NOT kind MATCHES "STATIC_LIBRARY|EXECUTABLE")
      continue()
    endif()
    get_target_property(sources ${target} SOURCES)
    list(LENGTH sources cost)  # the longest first: the last ones end together
    get_target_property(binary ${target} BINARY_DIR)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0
      UNITY_BUILD_CODE_BEFORE_INCLUDE "// NOLINTNEXTLINE(bugprone-suspicious-include)")
    file(RELATIVE_PATH name "${PROJECT_SOURCE_DIR}" "${folder}")
    set(name "${name} (${target})")
    add_test(NAME "${name}" COMMAND "${TALUS_CLANG_TIDY}" --quiet -p "${CMAKE_BINARY_DIR}" ${arguments}
      "${binary}/CMakeFiles/${target}.dir/Unity/unity_0_cxx.cxx" WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}")
    set_tests_properties("${name}" PROPERTIES LABELS tidy COST ${cost})
  endforeach()
  get_property(below DIRECTORY "${folder}" PROPERTY SUBDIRECTORIES)
  foreach(one IN LISTS below)
    talus_tidy_units("${one}")
  endforeach()
endfunction()

enable_testing()
talus_tidy_units("${PROJECT_SOURCE_DIR}")
