# The sources of the core and of the partitions, for core/CMakeLists.txt, those of the adapters, and those of
# proximity_mesh_reader.
set(HGRID_CORE_SOURCES
  src/bodies/forward_kinematics.cpp
  src/bodies/group_tree.cpp
  src/bodies/joined_robots.cpp
  src/bodies/joint_groups.cpp
  src/bodies/kinematics.cpp
  src/bodies/link_matrix.cpp
  src/bodies/motion_bound.cpp
  src/bodies/name.cpp
  src/bodies/name_index.cpp
  src/bodies/nearest_names.cpp
  src/bodies/robot_model.cpp
  src/bodies/self_pairs.cpp
  src/bodies/source.cpp
  src/broadphase/hgrid/bounds_tree.cpp
  src/broadphase/hgrid/box_sample.cpp
  src/broadphase/hgrid/box_statistics.cpp
  src/broadphase/hgrid/cell_costs.cpp
  src/broadphase/hgrid/cell_plan.cpp
  src/broadphase/hgrid/engine.cpp
  src/broadphase/hgrid/hgrid.cpp
  src/broadphase/hgrid/layer.cpp
  src/broadphase/hgrid/layer_plan.cpp
  src/broadphase/hgrid/layer_sort.cpp
  src/broadphase/hgrid/loose_boxes.cpp
  src/broadphase/hgrid/nearest.cpp
  src/broadphase/hgrid/occupancy.cpp
  src/broadphase/hgrid/pair_collection.cpp
  src/broadphase/hgrid/pair_search.cpp
  src/broadphase/hgrid/queries.cpp
  src/broadphase/hgrid/region_search.cpp
  src/broadphase/hgrid/region_tree.cpp
  src/broadphase/hgrid/search_tasks.cpp
  src/broadphase/hgrid/shape_levels.cpp
  src/broadphase/isa.cpp
  src/broadphase/room_edges.cpp
  src/broadphase/rooms.cpp
  src/broadphase/workers.cpp
  src/distances/map_meter.cpp
  src/distances/pair_distance.cpp
  src/distances/pair_meter.cpp
  src/explain/allowed_matrix.cpp
  src/explain/changed_pairs.cpp
  src/explain/explain.cpp
  src/geometry/aabb.cpp
  src/geometry/arc_tangent.cpp
  src/geometry/half_space.cpp
  src/geometry/inner_depth.cpp
  src/geometry/oriented_box.cpp
  src/geometry/pose.cpp
  src/geometry/rotation.cpp
  src/geometry/segment.cpp
  src/geometry/shape.cpp
  src/geometry/sine_cosine.cpp
  src/history/history.cpp
  src/history/kept_parts.cpp
  src/history/snapshot_record.cpp
  src/maps/cloud_cells.cpp
  src/maps/distance_blocks.cpp
  src/maps/map_gap.cpp
  src/maps/self_filter.cpp
  src/maps/static_grid.cpp
  src/maps/static_grid_search.cpp
  src/narrow/box_search.cpp
  src/narrow/box_tree.cpp
  src/narrow/convex_pair.cpp
  src/narrow/convex_solid.cpp
  src/narrow/core_narrow_phase.cpp
  src/narrow/depth_bound.cpp
  src/narrow/distance_lattice.cpp
  src/narrow/enclosure.cpp
  src/narrow/face_directions.cpp
  src/narrow/gjk.cpp
  src/narrow/inner_spheres.cpp
  src/narrow/mesh_hull.cpp
  src/narrow/mesh_pair.cpp
  src/narrow/mesh_solid.cpp
  src/narrow/mesh_tree.cpp
  src/narrow/narrow_phase.cpp
  src/narrow/ordered_solid.cpp
  src/narrow/overlap.cpp
  src/narrow/plane_pair.cpp
  src/narrow/triangle_gap.cpp
  src/narrow/winding_tree.cpp
  src/pairs/pair_choice.cpp
  src/pairs/pair_filter.cpp
  src/pairs/pair_margins.cpp
  src/pairs/pair_rule.cpp
  src/pairs/pair_tracker.cpp
  src/pairs/rule_book.cpp
  src/queries/answer.cpp
  src/queries/distance_field.cpp
  src/queries/doubt.cpp
  src/queries/doubtful_body.cpp
  src/queries/nearest_rounds.cpp
  src/queries/nearest_to_body.cpp
  src/queries/placed_map.cpp
  src/queries/placed_plane.cpp
  src/queries/query_limits.cpp
  src/queries/query_scope.cpp
  src/queries/segment_question.cpp
  src/queries/solid_question.cpp
  src/queries/sphere_question.cpp
  src/queries/states/checker_parts.cpp
  src/queries/states/clearance_gradient.cpp
  src/queries/states/edge_checker.cpp
  src/queries/states/edge_search.cpp
  src/queries/states/map_clearance.cpp
  src/queries/states/mesh_clearance.cpp
  src/queries/states/motion_bounds.cpp
  src/queries/states/robot_shapes.cpp
  src/queries/states/sphere_cover.cpp
  src/queries/states/state_checker.cpp
  src/queries/states/state_doubts.cpp
  src/queries/states/state_search.cpp
  src/queries/states/state_values.cpp
  src/queries/states/world_shapes.cpp
  src/refusal.cpp
  src/world/body_rooms.cpp
  src/world/commit.cpp
  src/world/completeness.cpp
  src/world/entering_bodies.cpp
  src/world/find_rooms.cpp
  src/world/grown_boxes.cpp
  src/world/horizon.cpp
  src/world/map_pairs.cpp
  src/world/new_structure.cpp
  src/world/pair_events.cpp
  src/world/plane_pairs.cpp
  src/world/prepared_bodies.cpp
  src/world/scene.cpp
  src/world/scene_structure.cpp
  src/world/snapshot.cpp
  src/world/structure.cpp
)
set(HGRID_PARTITION_SOURCES
  src/partitions/array_grid.cpp
  src/partitions/bit_grid.cpp
  src/partitions/broad_phase_type.cpp
  src/partitions/bucket_grid.cpp
  src/partitions/cell_scale.cpp
  src/partitions/hashed_grid.cpp
  src/partitions/hashed_hgrid.cpp
  src/partitions/kd_nodes.cpp
  src/partitions/kd_tree.cpp
  src/partitions/loose_octree.cpp
  src/partitions/mirtich_grid.cpp
  src/partitions/partition.cpp
  src/partitions/partition_changes.cpp
  src/partitions/partition_searches.cpp
  src/partitions/partitions.cpp
  src/partitions/query_shape.cpp
  src/partitions/sweep_array.cpp
  src/partitions/sweep_lists.cpp
  src/partitions/tree_grid.cpp
  src/partitions/uniform_grid.cpp
)
set(HGRID_ADAPTER_SOURCES
  src/adapters/mesh/mesh.cpp
  src/adapters/mesh/resource.cpp
  src/adapters/octomap/octomap.cpp
  src/adapters/octomap/octomap_header.cpp
  src/adapters/point_cloud/point_cloud.cpp
  src/adapters/urdf/srdf.cpp
  src/adapters/urdf/urdf.cpp
  src/adapters/urdf/urdf_tree.cpp
  src/adapters/urdf/xml.cpp
)
set(HGRID_MESH_FILE_SOURCES  # without the main function
  src/adapters/urdf/xml.cpp
  src/tools/mesh/dae_file.cpp
  src/tools/mesh/faces.cpp
  src/tools/mesh/obj_file.cpp
  src/tools/mesh/polygon.cpp
  src/tools/mesh/stl_file.cpp
)

# The inner loops of the broad phase are compiled once per instruction set. The program chooses one at run time.
set(HGRID_KERNEL_FLAGS_sse2 -msse2)
set(HGRID_KERNEL_FLAGS_avx2 -mavx2 -mfma -mbmi -mpopcnt)
set(HGRID_KERNEL_FLAGS_avx512 -mavx2 -mfma -mbmi -mpopcnt -mavx512f -mavx512vl -mavx512bw -mavx512dq)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # The AVX-512 header of gcc itself causes these warnings (gcc bug 105593). Clang does not know the first warning.
  list(APPEND HGRID_KERNEL_FLAGS_avx512 -Wno-maybe-uninitialized -Wno-uninitialized)
endif()

# A unity build compiles several files as one, because the compiler needs most of its time for the templates of Eigen,
# which the files have in common.
#catkin_lint: ignore_once global_var_collision
set(HGRID_UNITY 36 CACHE STRING "Number of files of the core that are compiled as one; 1 finds a missing #include")

# hgrid_add_kernels(target root): adds the inner loops to the core. They are optimized in every build type.
function(hgrid_add_kernels target root)
  set(isas portable)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
    target_compile_definitions(${target} PRIVATE HGRID_X86_KERNELS)
    list(APPEND isas sse2 avx2 avx512)
  elseif(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64|ARM64)$" AND CMAKE_SIZEOF_VOID_P EQUAL 8)
    # Checks the pointer size, because a 32-bit system may run on a 64-bit kernel. CMake then reports aarch64.
    target_compile_definitions(${target} PRIVATE HGRID_NEON_KERNELS)
    list(APPEND isas neon)
  endif()
  foreach(isa ${isas})
    set(kernels "${root}/src/broadphase/kernels/kernels_${isa}.cpp")
    target_sources(${target} PRIVATE "${kernels}")
    set_property(SOURCE "${kernels}" PROPERTY COMPILE_OPTIONS -O2 -ftree-vectorize ${HGRID_KERNEL_FLAGS_${isa}})
    # Kernels are built with other flags than all other files.
    set_property(SOURCE "${kernels}" PROPERTY SKIP_PRECOMPILE_HEADERS ON)
    set_property(SOURCE "${kernels}" PROPERTY SKIP_UNITY_BUILD_INCLUSION ON)
  endforeach()
endfunction()
