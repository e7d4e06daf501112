# talus_room(NAME [PUBLIC lib...] [PRIVATE lib...]): one folder of the house becomes one static library of all its *.cpp.
# A room sees only what it links; tests/unit/house/include_order_test.cpp holds the same order for #include lines.
function(talus_room name)
  cmake_parse_arguments(ROOM "" "" "PUBLIC;PRIVATE" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  add_library(${name} STATIC ${sources})
  target_link_libraries(${name} PUBLIC ${ROOM_PUBLIC} PRIVATE talus_compile ${ROOM_PRIVATE})
  # What an engine may link; TalusInstall installs it.
  file(RELATIVE_PATH folder "${PROJECT_SOURCE_DIR}" "${CMAKE_CURRENT_SOURCE_DIR}")
  if(folder MATCHES "^(core/|protocol$|client_sample/library$)")
    set_property(GLOBAL APPEND PROPERTY TALUS_INSTALLED_ROOMS ${name})
  endif()
endfunction()
