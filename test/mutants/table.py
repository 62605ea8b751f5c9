# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The mutants: (description of the fault, file in src/, text that is in the file exactly once, its replacement).

Each mutant is a fault that some broad phase had, or that a reviewer could easily overlook. Faults that only cost time
are not listed. Mutants of the same file follow each other, because the build then compiles fewer files.
"""

PAIRS_BODY = "broadphase/kernels/pairs_body.h"
BOXES_BODY = "broadphase/kernels/boxes_body.h"
LINE_BODY = "broadphase/kernels/line_body.h"
LINE_FILTER = "broadphase/kernels/line_filter_body.h"
AVX2 = "broadphase/kernels/simd_avx2.h"
LAYER = "broadphase/hgrid/layer.cpp"
ENGINE = "broadphase/hgrid/engine.cpp"
PAIRS = "broadphase/hgrid/pair_search.cpp"
LEVEL_BOUNDS = "broadphase/hgrid/level_bounds.cpp"
COLLECTION = "broadphase/hgrid/pair_collection.cpp"
HGRID = "broadphase/hgrid/hgrid.cpp"
QUERIES = "broadphase/hgrid/queries.cpp"
SCENE = "world/scene.cpp"
COMMIT = "world/commit.cpp"
EVENTS = "world/pair_events.cpp"
BRICKS = "maps/static_grid_bricks.h"
LINE = "maps/static_grid_line.h"
MAPS = "world/map_pairs.cpp"
SPHERE = "queries/sphere_question.cpp"
CLOUD = "maps/cloud_cells.cpp"

MUTANTS = [
    ("the pair search ignores the reach of the level", PAIRS_BODY,
     "cellsOf(l, first, 0, l.reach[x], grid, x, x_low);", "cellsOf(l, first, 0, 0.0f, grid, x, x_low);"),
    ("the pair search of a box covers only the cell of its minimum corner", PAIRS_BODY,
     "cellsOf(l, first, 3, 0.0f, grid, x, x_high);",
     "cellsOf(l, first, 0, 0.0f, grid, x, x_high);"),
    ("the pair search skips the last slab of cells", PAIRS_BODY,
     "z_span[k] = z_high[k] - z_own[k];", "z_span[k] = z_high[k] - z_own[k] - 1;"),
    ("the pair search of a box skips the next box", PAIRS_BODY,
     "next = first + k + 1,", "next = first + k + 2,"),
    ("the last block of boxes is treated as a full block", PAIRS_BODY,
     "count >= kBlock ? 0xffffu : (1u << count) - 1u", "count >= kBlock ? 0xffffu : 0xffffu"),
    ("the last collected encounters are never tested", PAIRS_BODY,
     "  encounters.hold(found);", ""),
    ("the search in another level ignores its reach", PAIRS_BODY,
     "b.reach[z], grid, z, z_low", "0.0f, grid, z, z_low"),
    ("a query ignores the reach of the level", BOXES_BODY,
     "cellOf(box.min[axis] - l.reach[axis], grid, axis)", "cellOf(box.min[axis], grid, axis)"),
    ("the search along a line ignores the reach of the boxes", LINE_BODY,
     "track.below + static_cast<double>(level.reach[axis]) * inverse", "track.below"),
    ("the cells along a line are chosen without its radius", LINE_BODY,
     "line.around * inverse + rounded", "rounded"),
    ("on a line, the outermost cells do not extend to infinity", LINE_BODY,
     "if (cell == 0.0) met", "if (false) met"),
    ("the quick test along a line ignores its radius", LINE_FILTER,
     "(2.0 * line.around + 2e-5 * farthest)", "(2e-5 * farthest)"),

    ("without SIMD, boxes that touch do not overlap", "broadphase/kernels/simd_portable.h",
     "j + k] <= box.max[axis]", "j + k] < box.max[axis]"),
    ("the last lane of a range is left out", AVX2,
     "count < kWidth ? kWidth - count : 0u", "count < kWidth ? kWidth - count + 1u : 0u"),
    ("the last lane is missing in the table of packed lanes", AVX2,
     "lane < 8", "lane < 7"),

    ("the reach is a length that was rounded down", LAYER,
     "std::nextafter(total.sizes[4 * i + axis], kInfinity)", "total.sizes[4 * i + axis]"),
    ("the positions in a layer are not computed again", ENGINE,
     "located[layer] = false;", ""),
    ("a removed box stays in its layer", ENGINE,
     "layers[from].withdraw(positions()[id]);", ""),
    ("pairs of boxes that moved away are kept", ENGINE,
     "else if (kept_dirty)", "else if (false)"),
    ("a removed box of the moving layer comes back", ENGINE,
     "started > 0 || moving_changed || ", "started > 0 || "),

    ("a level is not tested against the next coarser one", PAIRS,
     "coarser = level + 1", "coarser = level + 2"),
    ("boxes of different regions form no pairs", PAIRS,
     "meetAll(layer, region, layer, last);", ""),
    ("a region is tested against all regions except its neighbor", PAIRS,
     "if (number >= least) meet", "if (number > least) meet"),
    ("the bounds of 16 levels are those of the first", LEVEL_BOUNDS,
     "i < std::min(first + kernels::Tier::kFan, below.count)", "i < first + 1"),
    ("the bounds of a region end at the minimum corner of its last box", LAYER,
     "std::nextafter(upper[axis] + level.reach[axis], kInfinity)", "upper[axis]"),
    ("two layers are tested in one order only", PAIRS,
     "addTask(tasks, second, &first);", ""),
    ("boxes that were inserted one by one form no pairs", PAIRS,
     "{kMoving, kLoose}", "{kMoving}"),
    ("kept pairs remain after their second box has left", PAIRS,
     "used += layer_of[pair.first] <= kResting && layer_of[pair.second] <= kResting;",
     "used += layer_of[pair.first] <= kResting;"),
    ("the pairs that threads find are not filtered", PAIRS,
     "wanted_end_ = filter_.keep(pairs_, begin, end);", "wanted_end_ = end;"),
    ("the results of all threads are read from thread 0", PAIRS,
     "task.thread = thread;", "task.thread = 0;"),
    ("the search does not notice that it exceeds the limit of pairs", PAIRS,
     "if (all_pairs > bound_.pairs || all_overlaps", "if (all_overlaps"),
    ("the search does not notice that it exceeds the limit of overlaps", PAIRS,
     "|| all_overlaps > bound_.overlaps) exceeded_.store", ") exceeded_.store"),
    ("the search does not count the overlaps of resting boxes", PAIRS,
     "kept_valid ? kept_overlaps : 0", "0"),
    ("beyond the limit, arbitrary pairs are kept", COLLECTION,
     "std::nth_element(from + static_cast<std::ptrdiff_t>(begin), from + static_cast<std::ptrdiff_t>(most), "
     "pairs_.end());", ""),
    ("beyond the limit, fixed boxes with smaller ids are left out", COLLECTION,
     "count += other > id || isFixed(other) ? 1 : 0;", "count += other > id ? 1 : 0;"),
    ("beyond the limit, overlaps are not counted", COLLECTION,
     "overlaps_ += pairs_.size() - begin;", ""),
    ("boxes that become fixed are not sorted into the fixed layer", HGRID,
     "engine_->sortAll(true);", "engine_->sortAll();"),
    ("a bulk update skips small moves", HGRID,
     "if (box == given[i]) continue;",
     "if (box.min.isApprox(given[i].min, 1e-6f) && box.max.isApprox(given[i].max, 1e-6f)) continue;"),

    ("the box around a sphere is slightly too small", QUERIES,
     "sphere.radius + 2.0 * roundingSlack(sphere.center.cwiseAbs().maxCoeff() + sphere.radius)",
     "0.999 * sphere.radius"),
    ("hits along a segment are in reverse order", QUERIES,
     "a.along < b.along", "a.along > b.along"),
    ("the search for the nearest boxes ends as soon as it finds any box", QUERIES,
     "(enough && found[kept - 1].distance <= radius)", "kept > 0"),
    ("boxes near the corners of the box around a sphere count as hits", QUERIES,
     "query.center) <= near * near", "query.center) <= 3.0 * near * near"),
    ("a row of boxes on a line also includes the boxes after it", AVX2,
     "& ((1u << (count < kWidth ? count : kWidth)) - 1u)", "& 0xffu"),

    ("a segment in negative direction enters a box through the far side", "geometry/segment.cpp",
     "enter = std::max(enter, in);", "enter = std::max(enter, a);"),
    ("only the ends of the pieces of a segment are checked", "geometry/segment.cpp",
     "{lowest, end}", "{begin, end}"),
    ("a distance equal to the margin does not count", "geometry/aabb.cpp",
     "exactComparison(a, b, margin) <= 0.0", "exactComparison(a, b, margin) < 0.0"),
    ("the boxes of shapes are rounded inward", "geometry/shape.cpp",
     "roundedDown(low[i]", "roundedUp(low[i]"),

    ("small moves are skipped", SCENE,
     "slot.pose.world_from_body.matrix() == world_from_body.matrix()",
     "slot.pose.world_from_body.matrix().isApprox(world_from_body.matrix(), 1e-6)"),
    ("an old body id is valid for the next body in its slot", SCENE,
     "++slots[slot].generation;", ""),
    ("the margin is halved", COMMIT,
     "0.5 * options.margin + (", "0.25 * options.margin + ("),
    ("the boxes of stale bodies do not grow in the grid", COMMIT,
     " + pose.growth", ""),
    ("the gap of a pair is that of its farthest shapes", "pairs/pair_choice.cpp",
     ": a.gap < b.gap", ": a.gap > b.gap"),
    ("a tick uses the rounding mode of its caller", COMMIT,
     "const DefaultFloatEnvironment environment;\n  using Clock", "using Clock"),
    ("a pair ends without hysteresis", EVENTS,
     "margin + hysteresis_) &&", "margin) &&"),
    ("pairs of removed bodies end without an event", EVENTS,
     "else if (!epoch_began_) {", "else if (false) {"),
    ("a new body with the name of a removed body inherits its pairs", EVENTS,
     "order == 0 && was.ids[i] == now.ids[j]", "order == 0"),
    ("a pair that truncation removed ends", EVENTS,
     "if (now.is_cut && now.is_cut(", "if (false && now.is_cut("),
    ("the number of current pairs is not limited", EVENTS,
     "if (next_.size() + not_judged < most_) begin", "begin"),
    ("a pair that truncation removed loses its begin time", "pairs/pair_tracker.cpp",
     "if (is_cut && room > 0 &&", "if (false &&"),
    ("truncation keeps the first pairs by name instead of the nearest", "pairs/pair_choice.cpp",
     "return sorted_[a].gap != sorted_[b].gap ? sorted_[a].gap < sorted_[b].gap : a < b;", "return a < b;"),
    ("omitted pairs with maps are not reported", COMMIT,
     "snapshot.search_cut_ || !all_with_maps", "snapshot.search_cut_"),
    ("patterns of allowed pairs match in one order only", "pairs/pair_filter.cpp",
     "(as_first_[i] & as_second_[j]) | (as_second_[i] & as_first_[j])", "as_first_[i] & as_second_[j]"),
    ("after a new numbering of bodies, the pairs are not sorted", "pairs/pair_tracker.cpp",
     "{std::min(a, b), std::max(a, b), pair.since}", "{a, b, pair.since}"),
    ("each brick of a map is treated as the first child of its parent", BRICKS,
     "level.first_below[brick.number] + before", "level.first_below[brick.number]"),
    ("a search along a segment treats each brick as the first child of its parent", LINE,
     "static_cast<std::uint32_t>(bitCount(before))", "0u * static_cast<std::uint32_t>(bitCount(before))"),
    ("a search along a segment has no tolerance for rounding", LINE, "kRoom = 1.0f / (1 << 18)", "kRoom = 0.0f"),
    ("a search along a segment ignores its radius", LINE, "around_ = segment.radius + ", "around_ = "),
    ("a search along a segment ends after the first hit", LINE, "frame.left &= alongMain(frame);",
     "frame.left = 0;"),
    ("a falling segment enters its slices at the wrong end", LINE, "slices + std::min(slope, 0.0f)", "slices"),
    ("a gap to a map is reused although the map moved", MAPS,
     "map.cells == cells && map.world_from_map.matrix() == pose.matrix()", "map.cells == cells"),
    ("a gap to a map is reused although the body moved", MAPS,
     "known.up_to < up_to || known.box != box", "known.up_to < up_to"),
    ("the sweep between ticks ignores the motion of the map itself", MAPS,
     "boxInMap(map.mapFromWorldBefore(), from", "boxInMap(map.map_from_world, from"),
    ("space beyond the extent of a map counts as known", SPHERE,
     "return unmapped.extent.contains(grown(Eigen::AlignedBox3d(in_map.center), radius)) &&", "return"),
    ("a query trusts a stale map as much as a fresh one", SPHERE,
     "region_.radius + map.reach + touchSlack(region_", "region_.radius + touchSlack(region_"),
    ("a cell that a sensor sees again expires too early", CLOUD,
     "newest = std::max(newest, (known++)->stamp);", "newest = (known++)->stamp;"),
    ("a coordinate just below zero is put into the cell above", CLOUD,
     "whole - (cells < static_cast<double>(whole) ? 1 : 0)", "whole"),
    ("the box around a rotated box is too small", "maps/map_gap.cpp",
     "map_from_world.linear().cwiseAbs()", "map_from_world.linear()"),
]
