# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
#
# Sets HGRID_LIB_DESTINATION, the folder for libraries below the prefix, and HGRID_VERSION, as package.xml says.
if(CATKIN_GLOBAL_LIB_DESTINATION)
  set(HGRID_LIB_DESTINATION ${CATKIN_GLOBAL_LIB_DESTINATION})
else()
  include(GNUInstallDirs)
  set(HGRID_LIB_DESTINATION ${CMAKE_INSTALL_LIBDIR})
endif()
file(STRINGS "${CMAKE_CURRENT_LIST_DIR}/../package.xml" HGRID_VERSION REGEX "<version>")
string(REGEX REPLACE ".*<version>(.*)</version>.*" "\\1" HGRID_VERSION "${HGRID_VERSION}")
set(HGRID_PKG_CONFIG_FILE "${CMAKE_CURRENT_LIST_DIR}/library.pc.in")

# hgrid_export_library(name CMAKE package... PKG_CONFIG package... LINK library...): installs a CMake package and a
# pkg-config file for the library hgrid_proximity_<name>. Projects without catkin can then use the library, wherever the
# installed folder is moved to. It must be installed with EXPORT hgrid_proximity_<name>-targets. Usage:
#
#   find_package(hgrid_proximity_<name> REQUIRED)
#   target_link_libraries(my_program hgrid_proximity::<name>)
#
#   c++ my_program.cpp $(pkg-config --cflags --libs hgrid_proximity_<name>)
#
# CMAKE and PKG_CONFIG name the packages that users of the library also need. LINK names the foreign libraries that the
# library needs; with a static library, its users link them.
function(hgrid_export_library name)
  cmake_parse_arguments(needs "" "" "CMAKE;PKG_CONFIG;LINK" ${ARGN})
  set(package hgrid_proximity_${name})
  set_target_properties(${package} PROPERTIES EXPORT_NAME ${name})
  set(config "${CMAKE_CURRENT_BINARY_DIR}/${package}-config.cmake")
  file(WRITE "${config}" "include(CMakeFindDependencyMacro)\n")
  foreach(dependency ${needs_CMAKE})
    file(APPEND "${config}" "find_dependency(${dependency})\n")
  endforeach()
  file(APPEND "${config}" "include(\"\${CMAKE_CURRENT_LIST_DIR}/${package}-targets.cmake\")\n")
  include(CMakePackageConfigHelpers)
  set(version "${CMAKE_CURRENT_BINARY_DIR}/${package}-config-version.cmake")
  write_basic_package_version_file("${version}" VERSION ${HGRID_VERSION} COMPATIBILITY SameMinorVersion)
  set(folder ${HGRID_LIB_DESTINATION}/cmake/${package})
  install(EXPORT ${package}-targets NAMESPACE hgrid_proximity:: DESTINATION ${folder})
  install(FILES "${config}" "${version}" DESTINATION ${folder})

  # The file finds the prefix from its own place.
  set(folder ${HGRID_LIB_DESTINATION}/pkgconfig)
  file(RELATIVE_PATH to_prefix "/${folder}" /)
  string(REGEX REPLACE "/$" "" to_prefix "${to_prefix}")
  string(REPLACE ";" " " requires "${needs_PKG_CONFIG}")
  string(REPLACE ";" " " links "${needs_LINK}")
  set(private_links "")
  get_target_property(type ${package} TYPE)
  if(NOT type STREQUAL STATIC_LIBRARY)
    set(private_links "${links}")
    set(links "")
  endif()
  configure_file("${HGRID_PKG_CONFIG_FILE}" "${package}.pc" @ONLY)
  install(FILES "${CMAKE_CURRENT_BINARY_DIR}/${package}.pc" DESTINATION ${folder})
endfunction()
