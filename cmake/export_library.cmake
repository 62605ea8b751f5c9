# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors

# hgrid_export_library(name dependency...): installs a CMake package for the library hgrid_proximity_<name>. Projects
# without catkin can then use the library. It must be installed with EXPORT hgrid_proximity_<name>-targets. Usage:
#
#   find_package(hgrid_proximity_<name> REQUIRED)
#   target_link_libraries(my_program hgrid_proximity::<name>)
#
# Each dependency is the name of a CMake package that users of the library also need.
function(hgrid_export_library name)
  set(package hgrid_proximity_${name})
  set_target_properties(${package} PROPERTIES EXPORT_NAME ${name})
  set(config "${CMAKE_CURRENT_BINARY_DIR}/${package}-config.cmake")
  file(WRITE "${config}" "include(CMakeFindDependencyMacro)\n")
  foreach(dependency ${ARGN})
    file(APPEND "${config}" "find_dependency(${dependency})\n")
  endforeach()
  file(APPEND "${config}" "include(\"\${CMAKE_CURRENT_LIST_DIR}/${package}-targets.cmake\")\n")
  set(folder ${CATKIN_PACKAGE_LIB_DESTINATION}/cmake/${package})
  install(EXPORT ${package}-targets NAMESPACE hgrid_proximity:: DESTINATION ${folder})
  install(FILES "${config}" DESTINATION ${folder})
endfunction()
