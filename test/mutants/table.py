# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The mutants: (what is wrong, file under src/, text that stands there exactly once, what replaces it).

Each is a fault that a broad phase has had somewhere, or that a tired reviewer would let pass. Those of one file stand
together, because that saves the compiler a file.
"""

HGRID = "broadphase/hgrid.cpp"
SCENE = "scene/scene.cpp"

MUTANTS = [
    ("truncation instead of floor", HGRID,
     "std::floor(coordinate / edge)", "std::trunc(coordinate / edge)"),
    ("one level is never looked at", HGRID,
     "if ((occupied_ & levels) >> number & 1u)", "if (number != 9 && ((occupied_ & levels) >> number & 1u))"),
    ("pairs on the own level only, not the coarser ones", HGRID,
     "0u : ~0u << entry.level", "0u : 1u << entry.level"),
    ("the cell before a query's first is left out", HGRID,
     "level.edge) - 1;", "level.edge);"),
    ("oversize boxes are left out of pairs and box queries", HGRID,
     "for (const ProxyId id : oversize_) visit(id);\n}", "}"),
    ("oversize boxes are left out of segment queries", HGRID,
     "for (const ProxyId id : oversize_) visit(id);\n  std::sort", "std::sort"),
    ("a moved box stays in its old cell", HGRID,
     "withdraw(id);\n  place(id, box);", "entries_[id].box = box;"),
    ("the mask of levels is not set", HGRID,
     "if (level.count++ == 0) occupied_ |= 1u << entry.level;", "++level.count;"),
    ("the mask of levels is cleared too early", HGRID,
     "if (--level.count == 0)", "if (--level.count <= 1)"),
    ("a removed box leaves a wrong position behind", HGRID,
     "entries_[members.back()].position = entry.position;", ""),
    ("a box may reach over three cells", HGRID,
     "fits = high - low <= 1", "fits = high - low <= 2"),
    ("a slab of a segment ends one cell too early", HGRID,
     "(slab + 2.0)", "(slab + 1.0)"),
    ("hits along a segment come the wrong way round", HGRID,
     "a.along < b.along", "a.along > b.along"),

    ("a distance equal to the margin does not count", "geometry/aabb.cpp",
     "exactComparison(a, b, margin) <= 0.0", "exactComparison(a, b, margin) < 0.0"),
    ("the margin is compared with rounded squares", "geometry/aabb.cpp",
     "return exactComparison(a, b, margin) <= 0.0", "return squared <= limit"),
    ("boxes of shapes are rounded inward", "geometry/shape.cpp",
     "roundedDown(low[i]", "roundedUp(low[i]"),
    ("only the ends of a segment's pieces are looked at", "geometry/segment.cpp",
     "{lowest, end}", "{begin, end}"),

    ("the margin is halved", SCENE,
     "0.5 * options.margin + (", "0.25 * options.margin + ("),
    ("the smaller of two margins decides", SCENE,
     "std::max(structure->margin[first], structure->margin[second])",
     "std::min(structure->margin[first], structure->margin[second])"),
    ("stale bodies do not grow in the grid", SCENE,
     " + pose.growth", ""),
    ("small moves are skipped", SCENE,
     "slot.pose.world_from_body.matrix() == world_from_body.matrix()",
     "slot.pose.world_from_body.matrix().isApprox(world_from_body.matrix(), 1e-6)"),
    ("the gap is that of the farthest shapes", SCENE,
     "a.gap < b.gap", "a.gap > b.gap"),
    ("handles are valid for the next user of the slot", SCENE,
     "++slot.generation;", ""),
    ("a tick computes in the caller's rounding mode", SCENE,
     "const DefaultFloatEnvironment environment;\n  using Clock", "using Clock"),
    ("allowed patterns hold in one order only", "scene/pair_filter.cpp",
     "(as_first_[i] & as_second_[j]) | (as_second_[i] & as_first_[j])", "as_first_[i] & as_second_[j]"),
]
