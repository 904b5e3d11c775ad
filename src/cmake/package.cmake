# SPDX-License-Identifier: BSD-3-Clause
# find_package(tribo) and the uninstall target, once all libraries are known.
include(CMakePackageConfigHelpers)

get_property(TRIBO_COMPONENTS GLOBAL PROPERTY TRIBO_COMPONENTS)
get_target_property(type tribo TYPE)
string(COMPARE EQUAL "${type}" STATIC_LIBRARY TRIBO_STATIC)
configure_file("${CMAKE_CURRENT_LIST_DIR}/triboConfig.cmake.in" "${PROJECT_BINARY_DIR}/triboConfig.cmake" @ONLY)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/triboConfigVersion.cmake" COMPATIBILITY SameMajorVersion)
install(FILES "${PROJECT_BINARY_DIR}/triboConfig.cmake" "${PROJECT_BINARY_DIR}/triboConfigVersion.cmake"
  DESTINATION "${TRIBO_CMAKE_DIR}" COMPONENT development)
install(FILES "${CMAKE_CURRENT_LIST_DIR}/cholmod.cmake" DESTINATION "${TRIBO_CMAKE_DIR}" COMPONENT development
  RENAME tribo-cholmod.cmake)
# Each component may be installed alone, and brings the licence along.
foreach(component IN ITEMS runtime development tool)
  install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT ${component})
endforeach()

if(PROJECT_IS_TOP_LEVEL)
  add_custom_target(uninstall VERBATIM
    COMMAND "${CMAKE_COMMAND}" -D "MANIFEST=${PROJECT_BINARY_DIR}/install_manifest.txt"
            -P "${CMAKE_CURRENT_LIST_DIR}/uninstall.cmake")
endif()
