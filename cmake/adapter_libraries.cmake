# Finds the foreign libraries that the adapters use. The package, test/ and bench/ include this file. It sets:
#
#   HGRID_ADAPTER_INCLUDE_DIRS   include folders of all these libraries and of Eigen
#   HGRID_ADAPTER_LIBRARIES      urdfdom, console_bridge and tinyxml2: the libraries that HGRID_ADAPTER_SOURCES link
#   HGRID_ADAPTERS_MISSING       names of all headers and libraries that were not found; empty if all were found
#
# Searches headers and libraries by file name, because some CMake config files are unusable. On Ubuntu 20.04, tinyxml2
# has none. The config file of urdfdom caches a result that differs between the first and the second run of cmake.
find_package(Eigen3 REQUIRED)

find_path(HGRID_URDF_PARSER_INCLUDE_DIR urdf_parser/urdf_parser.h PATH_SUFFIXES urdfdom)
find_path(HGRID_URDF_MODEL_INCLUDE_DIR urdf_model/model.h PATH_SUFFIXES urdfdom_headers)
find_path(HGRID_URDF_EXCEPTION_INCLUDE_DIR urdf_exception/exception.h PATH_SUFFIXES urdfdom_headers)
find_library(HGRID_URDFDOM_MODEL_LIBRARY urdfdom_model)
find_path(HGRID_CONSOLE_BRIDGE_INCLUDE_DIR console_bridge/console.h)
find_library(HGRID_CONSOLE_BRIDGE_LIBRARY console_bridge)
find_path(HGRID_TINYXML2_INCLUDE_DIR tinyxml2.h)
find_library(HGRID_TINYXML2_LIBRARY tinyxml2)

set(HGRID_ADAPTERS_MISSING)
foreach(library URDF_PARSER_INCLUDE_DIR URDF_MODEL_INCLUDE_DIR URDF_EXCEPTION_INCLUDE_DIR URDFDOM_MODEL_LIBRARY
    CONSOLE_BRIDGE_INCLUDE_DIR CONSOLE_BRIDGE_LIBRARY TINYXML2_INCLUDE_DIR TINYXML2_LIBRARY)
  mark_as_advanced(HGRID_${library})
  if(NOT HGRID_${library})
    list(APPEND HGRID_ADAPTERS_MISSING ${library})
  endif()
endforeach()

if(NOT HGRID_ADAPTERS_MISSING)
  set(HGRID_ADAPTER_INCLUDE_DIRS ${EIGEN3_INCLUDE_DIRS} ${HGRID_URDF_PARSER_INCLUDE_DIR}
    ${HGRID_URDF_MODEL_INCLUDE_DIR} ${HGRID_URDF_EXCEPTION_INCLUDE_DIR} ${HGRID_CONSOLE_BRIDGE_INCLUDE_DIR}
    ${HGRID_TINYXML2_INCLUDE_DIR})
  list(REMOVE_DUPLICATES HGRID_ADAPTER_INCLUDE_DIRS)
  list(REMOVE_ITEM HGRID_ADAPTER_INCLUDE_DIRS /usr/include)  # the compiler always searches this folder; naming it would
                                                             # break #include_next
  set(HGRID_ADAPTER_LIBRARIES ${HGRID_URDFDOM_MODEL_LIBRARY} ${HGRID_CONSOLE_BRIDGE_LIBRARY} ${HGRID_TINYXML2_LIBRARY})
endif()

# hgrid_mesh_reader_options(target): sets the options for the target of proximity_mesh_reader.
function(hgrid_mesh_reader_options target)
  if(HGRID_SANITIZE MATCHES "undefined")
    target_compile_options(${target} PRIVATE -fno-sanitize=vptr)  # vptr opens files; the reader must not
  endif()
endfunction()
