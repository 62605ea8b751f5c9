# Finds FCL, a reference of the tests and a peer in the benchmarks, and OctoMap, which its headers include. test/ and
# bench/ include this file. It sets HGRID_<NAME>_INCLUDE_DIR or HGRID_<NAME>_LIBRARY, to ...-NOTFOUND if there is none.
find_path(HGRID_FCL_INCLUDE_DIR fcl/narrowphase/distance.h)  # FCL 0.5 has no such file; Noetic installs 0.5 and 0.6
find_path(HGRID_OCTOMAP_INCLUDE_DIR octomap/octomap.h)
find_library(HGRID_FCL_LIBRARY fcl)
find_library(HGRID_CCD_LIBRARY ccd)
find_library(HGRID_OCTOMAP_LIBRARY octomap)
find_library(HGRID_OCTOMATH_LIBRARY octomath)
mark_as_advanced(HGRID_FCL_INCLUDE_DIR HGRID_OCTOMAP_INCLUDE_DIR HGRID_FCL_LIBRARY HGRID_CCD_LIBRARY
  HGRID_OCTOMAP_LIBRARY HGRID_OCTOMATH_LIBRARY)
