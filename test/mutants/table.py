# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The mutants: (what is wrong, file under src/, text that stands there exactly once, what replaces it).

Each is a fault that a broad phase has had somewhere, or that a tired reviewer would let pass; what only costs time is
none. Those of one file stand together, because that saves the compiler a file.
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
    ("boxes of a level look around without its reach", PAIRS_BODY,
     "cellsOf(l, first, 0, l.reach[x], grid, x, x_low);", "cellsOf(l, first, 0, 0.0f, grid, x, x_low);"),
    ("a box looks no farther than the cell of its minimum", PAIRS_BODY,
     "cellsOf(l, first, 3, 0.0f, grid, x, x_high);",
     "cellsOf(l, first, 0, 0.0f, grid, x, x_high);"),
    ("the last slab is not looked at", PAIRS_BODY,
     "z_span[k] = z_high[k] - z_own[k];", "z_span[k] = z_high[k] - z_own[k] - 1;"),
    ("the first box after a box is skipped", PAIRS_BODY,
     "next = first + k + 1,", "next = first + k + 2,"),
    ("the last block of boxes is taken for a full one", PAIRS_BODY,
     "count >= kBlock ? 0xffffu : (1u << count) - 1u", "count >= kBlock ? 0xffffu : 0xffffu"),
    ("encounters that were collected last are never held", PAIRS_BODY,
     "  encounters.hold(found);", ""),
    ("another level is looked at without its reach", PAIRS_BODY,
     "b.reach[z], grid, z, z_low", "0.0f, grid, z, z_low"),
    ("a query looks around without the reach", BOXES_BODY,
     "cellOf(box.min[axis] - l.reach[axis], grid, axis)", "cellOf(box.min[axis], grid, axis)"),
    ("along a line cells are looked at without the reach of their boxes", LINE_BODY,
     "track.below + static_cast<double>(level.reach[axis]) * inverse", "track.below"),
    ("the cells along a line forget its radius", LINE_BODY,
     "line.around * inverse + rounded", "rounded"),
    ("along a line the outermost cells end like all others", LINE_BODY,
     "if (cell == 0.0) met", "if (false) met"),
    ("the quick test along a line forgets its radius", LINE_FILTER,
     "(2.0 * line.around + 2e-5 * farthest)", "(2e-5 * farthest)"),

    ("boxes that touch do not overlap, without SIMD", "broadphase/kernels/simd_portable.h",
     "j + k] <= box.max[axis]", "j + k] < box.max[axis]"),
    ("the last lane of a range is left out", AVX2,
     "count < kWidth ? kWidth - count : 0u", "count < kWidth ? kWidth - count + 1u : 0u"),
    ("the last lane is missing in the table of packed lanes", AVX2,
     "lane < 8", "lane < 7"),

    ("a length that was rounded down is the reach", LAYER,
     "std::nextafter(total.sizes[4 * i + axis], kInfinity)", "total.sizes[4 * i + axis]"),
    ("positions of a layer are not made anew", ENGINE,
     "located[layer] = false;", ""),
    ("a removed box stays in its layer", ENGINE,
     "layers[from].withdraw(positions()[id]);", ""),
    ("pairs of what moved away are kept", ENGINE,
     "else if (kept_dirty)", "else if (false)"),
    ("a removed box among the moving comes back", ENGINE,
     "started > 0 || moving_changed || ", "started > 0 || "),

    ("a level is not tested against the next coarser one", PAIRS,
     "coarser = level + 1", "coarser = level + 2"),
    ("boxes of different regions make no pairs", PAIRS,
     "meetAll(layer, region, layer, last);", ""),
    ("a region meets each other one but its neighbor", PAIRS,
     "if (number >= least) meet", "if (number > least) meet"),
    ("the bounds of 16 levels are those of the first", LEVEL_BOUNDS,
     "i < std::min(first + kernels::Tier::kFan, below.count)", "i < first + 1"),
    ("bounds of a region end where its last box begins", LAYER,
     "std::nextafter(upper[axis] + level.reach[axis], kInfinity)", "upper[axis]"),
    ("layers are asked one way round only", PAIRS,
     "addTask(tasks, second, &first);", ""),
    ("boxes that came one by one make no pairs", PAIRS,
     "{kMoving, kLoose}", "{kMoving}"),
    ("kept pairs outlive the second of their boxes", PAIRS,
     "used += layer_of[pair.first] <= kResting && layer_of[pair.second] <= kResting;",
     "used += layer_of[pair.first] <= kResting;"),
    ("pairs that threads find are not filtered", PAIRS,
     "wanted_end_ = filter_.keep(pairs_, begin, end);", "wanted_end_ = end;"),
    ("what threads find goes where another thread found it", PAIRS,
     "task.thread = thread;", "task.thread = 0;"),
    ("the search exceeds the bound of its pairs unnoticed", PAIRS,
     "if (all_pairs > bound_.pairs || all_overlaps", "if (all_overlaps"),
    ("the search exceeds the bound of its overlaps unnoticed", PAIRS,
     "|| all_overlaps > bound_.overlaps) exceeded_.store", ") exceeded_.store"),
    ("a search forgets the overlaps of boxes that rest", PAIRS,
     "kept_valid ? kept_overlaps : 0", "0"),
    ("beyond the bound any pairs are taken", COLLECTION,
     "std::nth_element(from + static_cast<std::ptrdiff_t>(begin), from + static_cast<std::ptrdiff_t>(most), "
     "pairs_.end());", ""),
    ("beyond the bound fixed boxes with smaller ids are left out", COLLECTION,
     "count += other > id || isFixed(other) ? 1 : 0;", "count += other > id ? 1 : 0;"),
    ("beyond the bound overlaps are not counted", COLLECTION,
     "overlaps_ += pairs_.size() - begin;", ""),
    ("what is fixed stays what it was", HGRID,
     "engine_->sortAll(true);", "engine_->sortAll();"),
    ("small moves are skipped in bulk", HGRID,
     "if (box == given[i]) continue;",
     "if (box.min.isApprox(given[i].min, 1e-6f) && box.max.isApprox(given[i].max, 1e-6f)) continue;"),

    ("a sphere's box is a little too small", QUERIES,
     "sphere.radius + 2.0 * roundingSlack(sphere.center.cwiseAbs().maxCoeff() + sphere.radius)",
     "0.999 * sphere.radius"),
    ("hits along a segment come the wrong way round", QUERIES,
     "a.along < b.along", "a.along > b.along"),
    ("the nearest are those in the first sphere that is not empty", QUERIES,
     "(enough && found[kept - 1].distance <= radius)", "kept > 0"),
    ("all that overlaps the box around a sphere touches the sphere", QUERIES,
     "query.center) <= near * near", "query.center) <= 3.0 * near * near"),
    ("the boxes after a row that a line passes are looked at with it", AVX2,
     "& ((1u << (count < kWidth ? count : kWidth)) - 1u)", "& 0xffu"),

    ("a segment that goes down an axis enters through the far side", "geometry/segment.cpp",
     "enter = std::max(enter, in);", "enter = std::max(enter, a);"),
    ("only the ends of a segment's pieces are looked at", "geometry/segment.cpp",
     "{lowest, end}", "{begin, end}"),
    ("a distance equal to the margin does not count", "geometry/aabb.cpp",
     "exactComparison(a, b, margin) <= 0.0", "exactComparison(a, b, margin) < 0.0"),
    ("boxes of shapes are rounded inward", "geometry/shape.cpp",
     "roundedDown(low[i]", "roundedUp(low[i]"),

    ("small moves are skipped", SCENE,
     "slot.pose.world_from_body.matrix() == world_from_body.matrix()",
     "slot.pose.world_from_body.matrix().isApprox(world_from_body.matrix(), 1e-6)"),
    ("handles are valid for the next user of the slot", SCENE,
     "++slots[slot].generation;", ""),
    ("the margin is halved", COMMIT,
     "0.5 * options.margin + (", "0.25 * options.margin + ("),
    ("stale bodies do not grow in the grid", COMMIT,
     " + pose.growth", ""),
    ("the gap is that of the farthest shapes", "pairs/pair_choice.cpp",
     ": a.gap < b.gap", ": a.gap > b.gap"),
    ("a tick computes in the caller's rounding mode", COMMIT,
     "const DefaultFloatEnvironment environment;\n  using Clock", "using Clock"),
    ("a pair's end is told without the hysteresis", EVENTS,
     "margin + hysteresis_) &&", "margin) &&"),
    ("pairs of what is gone end without a word", EVENTS,
     "else if (!epoch_began_) {", "else if (false) {"),
    ("who takes the name of a body that is gone takes its pairs too", EVENTS,
     "order == 0 && was.ids[i] == now.ids[j]", "order == 0"),
    ("a pair that truncation removed ends", EVENTS,
     "if (now.is_cut && now.is_cut(", "if (false && now.is_cut("),
    ("any number of pairs may be on", EVENTS,
     "if (next_.size() + not_judged < most_) begin", "begin"),
    ("a pair that truncation removed is interrupted", "pairs/pair_tracker.cpp",
     "if (is_cut && room > 0 &&", "if (false &&"),
    ("truncation keeps the first pairs by name", "pairs/pair_choice.cpp",
     "return sorted_[a].gap != sorted_[b].gap ? sorted_[a].gap < sorted_[b].gap : a < b;", "return a < b;"),
    ("pairs with maps that are left out are not said", COMMIT,
     "snapshot.search_cut_ || !all_with_maps", "snapshot.search_cut_"),
    ("allowed patterns hold in one order only", "pairs/pair_filter.cpp",
     "(as_first_[i] & as_second_[j]) | (as_second_[i] & as_first_[j])", "as_first_[i] & as_second_[j]"),
    ("a new numbering leaves the pairs unsorted", "pairs/pair_tracker.cpp",
     "{std::min(a, b), std::max(a, b), pair.since}", "{a, b, pair.since}"),
    ("every brick of a map is taken for the first below its parent", BRICKS,
     "level.first_below[brick.number] + before", "level.first_below[brick.number]"),
    ("a search along a segment takes every brick for the first below its parent", LINE,
     "static_cast<std::uint32_t>(bitCount(before))", "0u * static_cast<std::uint32_t>(bitCount(before))"),
    ("a search along a segment has no room for rounding", LINE, "kRoom = 1.0f / (1 << 18)", "kRoom = 0.0f"),
    ("a search along a segment takes a capsule for a line", LINE, "around_ = segment.radius + ", "around_ = "),
    ("a search along a segment ends with what it finds first", LINE, "frame.left &= alongMain(frame);",
     "frame.left = 0;"),
    ("a segment's slices are entered where a rising one enters them", LINE, "slices + std::min(slope, 0.0f)", "slices"),
    ("a gap to a map is remembered though the map moved", MAPS,
     "map.cells == cells && map.world_from_map.matrix() == pose.matrix()", "map.cells == cells"),
    ("a gap to a map is remembered though the body moved", MAPS,
     "known.up_to < up_to || known.box != box", "known.up_to < up_to"),
    ("a map's own moves are not swept", MAPS,
     "boxInMap(map.mapFromWorldBefore(), from", "boxInMap(map.map_from_world, from"),
    ("what lies beyond a map counts as known", SPHERE,
     "return unmapped.extent.contains(grown(Eigen::AlignedBox3d(in_map.center), radius)) &&", "return"),
    ("a stale map knows as much as a fresh one", SPHERE,
     "region_.radius + map.reach + touchSlack(region_", "region_.radius + touchSlack(region_"),
    ("what a sensor sees again goes as if it had not", CLOUD,
     "newest = std::max(newest, (known++)->stamp);", "newest = (known++)->stamp;"),
    ("just below zero lies in the cell above", CLOUD,
     "whole - (cells < static_cast<double>(whole) ? 1 : 0)", "whole"),
    ("the box around a turned box is too small", "maps/map_gap.cpp",
     "map_from_world.linear().cwiseAbs()", "map_from_world.linear()"),
]
