# The core: C++17 and Eigen, no ROS. Shared by the package and by the project in test/.
set(HGRID_CORE_SOURCES
  src/broadphase/engine.cpp
  src/broadphase/hgrid.cpp
  src/broadphase/isa.cpp
  src/broadphase/layer.cpp
  src/broadphase/pair_search.cpp
  src/broadphase/plan.cpp
  src/broadphase/queries.cpp
  src/broadphase/static_grid.cpp
  src/broadphase/static_grid_search.cpp
  src/broadphase/workers.cpp
  src/geometry/aabb.cpp
  src/geometry/pose.cpp
  src/geometry/segment.cpp
  src/geometry/shape.cpp
  src/geometry/sphere.cpp
  src/narrowphase/enclosure.cpp
  src/narrowphase/gjk.cpp
  src/narrowphase/narrow_phase.cpp
  src/refusal.cpp
  src/scene/allowed_matrix.cpp
  src/scene/cloud_cells.cpp
  src/scene/commit.cpp
  src/scene/explain.cpp
  src/scene/group_tree.cpp
  src/scene/horizon.cpp
  src/scene/link_matrix.cpp
  src/scene/map_gap.cpp
  src/scene/map_meter.cpp
  src/scene/map_pairs.cpp
  src/scene/motion_bound.cpp
  src/scene/name.cpp
  src/scene/name_index.cpp
  src/scene/nearest_names.cpp
  src/scene/pair_events.cpp
  src/scene/pair_filter.cpp
  src/scene/pair_margins.cpp
  src/scene/pair_meter.cpp
  src/scene/pair_rule.cpp
  src/scene/pair_tracker.cpp
  src/scene/robot_model.cpp
  src/scene/rule_book.cpp
  src/scene/scene.cpp
  src/scene/self_filter.cpp
  src/scene/self_pairs.cpp
  src/scene/snapshot.cpp
  src/scene/snapshot_maps.cpp
  src/scene/snapshot_nearest.cpp
  src/scene/snapshot_queries.cpp
  src/scene/snapshot_unmapped.cpp
)
set(HGRID_ADAPTER_SOURCES
  src/adapters/fcl.cpp
  src/adapters/fcl_mesh.cpp
  src/adapters/fcl_solid.cpp
  src/adapters/mesh.cpp
  src/adapters/octomap.cpp
  src/adapters/octomap_header.cpp
  src/adapters/point_cloud.cpp
  src/adapters/resource.cpp
  src/adapters/srdf.cpp
  src/adapters/urdf.cpp
  src/adapters/urdf_tree.cpp
  src/adapters/xml.cpp
)

# The inner loops of the broad phase, once per instruction set; which is used is decided when the program runs.
set(HGRID_KERNEL_FLAGS_sse2 -msse2)
set(HGRID_KERNEL_FLAGS_avx2 -mavx2 -mfma -mbmi -mpopcnt)
# gcc's own header of AVX-512 warns of itself (its bug 105593).
set(HGRID_KERNEL_FLAGS_avx512 -mavx2 -mfma -mbmi -mpopcnt -mavx512f -mavx512vl -mavx512bw -mavx512dq -Wno-maybe-uninitialized
  -Wno-uninitialized)

# hgrid_core_options(target root): what a target made of the core's sources needs. Kernels are optimised whatever the
# build type is, but -ffp-contract=off must hold for them as for the rest: one formula rounds one way everywhere.
function(hgrid_core_options target root)
  target_include_directories(${target} PRIVATE "${root}/src")
  target_compile_options(${target} PRIVATE -ffp-contract=off)
  set(isas portable)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    target_compile_definitions(${target} PRIVATE HGRID_X86_KERNELS)
    list(APPEND isas sse2 avx2 avx512)
  endif()
  foreach(isa ${isas})
    set(kernels "${root}/src/broadphase/kernels/kernels_${isa}.cpp")
    target_sources(${target} PRIVATE "${kernels}")
    set_property(SOURCE "${kernels}" PROPERTY COMPILE_OPTIONS -O2 -ftree-vectorize ${HGRID_KERNEL_FLAGS_${isa}})
    set_property(SOURCE "${kernels}" PROPERTY SKIP_PRECOMPILE_HEADERS ON)  # made for other flags
  endforeach()
endfunction()
