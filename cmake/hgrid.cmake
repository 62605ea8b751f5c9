# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
#
# What the package, core/, test/, test/fuzz and bench/ have in common. Sets HGRID_ROOT, the folder of the repository.
get_filename_component(HGRID_ROOT "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)
# Without these, only some machines would use fused multiply-add, and results would differ. Eigen uses it on ARM where
# the compiler says that it is there.
set(HGRID_SAME_DIGITS -ffp-contract=off -U__ARM_FEATURE_FMA)

# hgrid_compiler_options(): the language, the warnings and the sanitizers of the package, test/ and bench/.
macro(hgrid_compiler_options)
  if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo or MinSizeRel" FORCE)
  endif()
  set(CMAKE_CXX_STANDARD 17)
  set(CMAKE_CXX_STANDARD_REQUIRED ON)
  set(CMAKE_CXX_EXTENSIONS OFF)
  add_compile_options(-Wall -Wextra ${HGRID_SAME_DIGITS})
  option(HGRID_WERROR "Treat compiler warnings as errors; for the compilers that the tests use" OFF)
  if(HGRID_WERROR)
    add_compile_options(-Werror)
  endif()
  set(HGRID_SANITIZE "" CACHE STRING "Sanitizers to build with: address,undefined or thread")
  if(HGRID_SANITIZE)
    add_compile_options(-fsanitize=${HGRID_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    add_link_options(-fsanitize=${HGRID_SANITIZE})
  endif()
endmacro()

# hgrid_files(variable pattern... [EXCLUDE regex]): sets the variable to the files that match, sorted, without those
# whose name begins with `regex`. The build runs cmake again when another file matches. Each pattern must match a
# file, so that no test is lost by a typing error. Relative patterns begin at the current source folder.
function(hgrid_files variable)
  cmake_parse_arguments(files "" "EXCLUDE" "" ${ARGN})
  set(all "")
  foreach(pattern ${files_UNPARSED_ARGUMENTS})
    file(GLOB matching CONFIGURE_DEPENDS "${pattern}")
    if(NOT matching)
      message(FATAL_ERROR "no file matches ${pattern} in ${CMAKE_CURRENT_SOURCE_DIR}")
    endif()
    list(APPEND all ${matching})
  endforeach()
  if(files_EXCLUDE)
    list(FILTER all EXCLUDE REGEX "/(${files_EXCLUDE})[^/]*$")
  endif()
  list(REMOVE_DUPLICATES all)
  list(SORT all)
  set(${variable} ${all} PARENT_SCOPE)
endfunction()

# hgrid_find(prefix file...): finds foreign headers and libraries. Sets prefix_INCLUDE_DIRS, prefix_LIBRARIES, for each
# file HGRID_<NAME>_INCLUDE_DIR or HGRID_<NAME>_LIBRARY, and prefix_MISSING, the names of those that were not found.
# Searches by file name, because some CMake config files are unusable: on Ubuntu 20.04, tinyxml2 has none, and that of
# urdfdom caches a result that differs between the first and the second run of cmake.
function(hgrid_find prefix)
  set(dirs "")
  set(libraries "")
  set(missing "")
  foreach(file ${ARGN})
    string(REGEX REPLACE "[^A-Za-z0-9_].*" "" name "${file}")
    string(TOUPPER "HGRID_${name}" name)
    if(file MATCHES "\\.h(pp)?$")
      find_path(${name}_INCLUDE_DIR ${file} PATH_SUFFIXES bullet urdfdom urdfdom_headers)
      set(name ${name}_INCLUDE_DIR)
      list(APPEND dirs ${${name}})
    else()
      find_library(${name}_LIBRARY ${file})
      set(name ${name}_LIBRARY)
      list(APPEND libraries ${${name}})
    endif()
    mark_as_advanced(${name})
    if(NOT ${name})
      list(APPEND missing ${name})
    endif()
  endforeach()
  list(REMOVE_DUPLICATES dirs)
  list(REMOVE_ITEM dirs /usr/include)  # the compiler always searches this folder; naming it would break #include_next
  set(${prefix}_INCLUDE_DIRS ${dirs} PARENT_SCOPE)
  set(${prefix}_LIBRARIES ${libraries} PARENT_SCOPE)
  set(${prefix}_MISSING ${missing} PARENT_SCOPE)
endfunction()
# What the adapters need, and FCL with OctoMap: references of the tests and peers in the benchmarks.
set(HGRID_ADAPTER_NEEDS urdf_parser/urdf_parser.h urdf_model/model.h urdf_exception/exception.h console_bridge/console.h
  tinyxml2.h urdfdom_model console_bridge tinyxml2)
set(HGRID_OCTOMAP_NEEDS octomap/octomap.h octomap octomath)
set(HGRID_FCL_NEEDS fcl/narrowphase/distance.h fcl ccd ${HGRID_OCTOMAP_NEEDS})  # FCL 0.5 has no such header

# hgrid_add_library(name SOURCES file... NEEDS target... [LINK library...] [CMAKE package...] [PKG_CONFIG package...]):
# adds the library hgrid_proximity_<name>. Projects without catkin can use what is installed, wherever the folder is
# moved to: by find_package(hgrid_proximity_<name>), which has the target hgrid_proximity::<name>, or by pkg-config.
# NEEDS: targets that users link, too; CMAKE, PKG_CONFIG: their packages. LINK: foreign libraries; with a static library,
# users link them.
function(hgrid_add_library name)
  cmake_parse_arguments(library "" "" "SOURCES;NEEDS;LINK;CMAKE;PKG_CONFIG" ${ARGN})
  # A unity build compiles several files as one, because the compiler needs most of its time for the templates of Eigen.
  #catkin_lint: ignore_once global_var_collision
  set(HGRID_UNITY 36 CACHE STRING "Number of files of a library that are compiled as one; 1 finds a missing #include")
  set(package hgrid_proximity_${name})
  add_library(${package} ${library_SOURCES})
  add_library(hgrid_proximity::${name} ALIAS ${package})
  set_target_properties(${package} PROPERTIES
    EXPORT_NAME ${name} UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${HGRID_UNITY})
  target_compile_features(${package} PUBLIC cxx_std_17)
  target_compile_options(${package} PRIVATE ${HGRID_SAME_DIGITS})
  target_include_directories(${package} PRIVATE "${HGRID_ROOT}/src"
    PUBLIC $<BUILD_INTERFACE:${HGRID_ROOT}/include> $<INSTALL_INTERFACE:include>)
  target_link_libraries(${package} PUBLIC ${library_NEEDS} PRIVATE ${library_LINK})
  if(CATKIN_GLOBAL_LIB_DESTINATION)
    set(lib ${CATKIN_GLOBAL_LIB_DESTINATION})
  else()
    include(GNUInstallDirs)
    set(lib ${CMAKE_INSTALL_LIBDIR})
  endif()
  file(STRINGS "${HGRID_ROOT}/package.xml" version REGEX "<version>")
  string(REGEX REPLACE ".*<version>(.*)</version>.*" "\\1" version "${version}")
  set(config "${CMAKE_CURRENT_BINARY_DIR}/${package}-config")
  configure_file("${HGRID_ROOT}/cmake/config.cmake.in" "${config}.cmake" @ONLY)
  include(CMakePackageConfigHelpers)
  write_basic_package_version_file("${config}-version.cmake" VERSION ${version} COMPATIBILITY SameMinorVersion)
  install(TARGETS ${package} EXPORT ${package}-targets
    ARCHIVE DESTINATION ${lib} LIBRARY DESTINATION ${lib} RUNTIME DESTINATION bin)
  install(EXPORT ${package}-targets NAMESPACE hgrid_proximity:: DESTINATION ${lib}/cmake/${package})
  install(FILES "${config}.cmake" "${config}-version.cmake" DESTINATION ${lib}/cmake/${package})
  file(RELATIVE_PATH to_prefix "/${lib}/pkgconfig" /)  # the pkg-config file finds the prefix from its own place
  string(REGEX REPLACE "/$" "" to_prefix "${to_prefix}")
  string(REPLACE ";" " " requires "${library_PKG_CONFIG}")
  string(REPLACE ";" " " links "${library_LINK}")
  set(private_links "")
  get_target_property(type ${package} TYPE)
  if(NOT type STREQUAL STATIC_LIBRARY)
    set(private_links "${links}")
    set(links "")
  endif()
  configure_file("${HGRID_ROOT}/cmake/library.pc.in" "${package}.pc" @ONLY)
  install(FILES "${CMAKE_CURRENT_BINARY_DIR}/${package}.pc" DESTINATION ${lib}/pkgconfig)
endfunction()

# hgrid_install_python(program...): lets what catkin_install_python() installs begin with the interpreter that the build
# was configured with, as in the devel space, not with "/usr/bin/env python3". If conda or pyenv is first in PATH, that is
# the wrong Python: it does not find the modules of ROS.
function(hgrid_install_python)
  foreach(program ${ARGN})
    get_filename_component(name ${program} NAME)
    set(installed "\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CATKIN_PACKAGE_BIN_DESTINATION}/${name}")
    install(CODE "execute_process(COMMAND sed -i \"1s|.*|#!${PYTHON_EXECUTABLE}|\" \"${installed}\")")
  endforeach()
endfunction()
