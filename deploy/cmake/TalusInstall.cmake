# `cmake --install build/release --prefix DIR`: the programs, and what an engine links: `find_package(talus)` gives it
# talus::client (the connection), talus::protocol (bytes <-> values) and talus::mesh (the world function itself).
#
# Every room under core/, protocol/ and client_sample/library is a static library of the export set; talus_room enters them
# into TALUS_INSTALLED_ROOMS. Headers keep their paths ("core/grid/chunk_key.hpp") below include/talus.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY TALUS_INSTALLED_ROOMS)
set(headers "${CMAKE_INSTALL_INCLUDEDIR}/talus")
set(package "${CMAKE_INSTALL_LIBDIR}/cmake/talus")
foreach(room IN LISTS rooms)
  string(REGEX REPLACE "^talus_" "" name "${room}")
  set_target_properties(${room} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(${room} SYSTEM INTERFACE "$<INSTALL_INTERFACE:${headers}>")
endforeach()
# Static libraries name what they were compiled with; of ours that is switches, which no consumer inherits.
install(TARGETS ${rooms} talus_compile talus_asio talus_llhttp EXPORT talus ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(EXPORT talus NAMESPACE talus:: DESTINATION "${package}" FILE talus_targets.cmake)
install(DIRECTORY core protocol DESTINATION "${headers}" FILES_MATCHING PATTERN "*.hpp" PATTERN schema EXCLUDE)
install(DIRECTORY client_sample/library DESTINATION "${headers}/client_sample" FILES_MATCHING PATTERN "*.hpp")
configure_package_config_file(deploy/cmake/talus-config.cmake.in "${PROJECT_BINARY_DIR}/talus-config.cmake" INSTALL_DESTINATION "${package}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/talus-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/talus-config.cmake" "${PROJECT_BINARY_DIR}/talus-config-version.cmake" DESTINATION "${package}")

install(TARGETS talusd talus RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
