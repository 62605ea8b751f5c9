// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "bench/workload/layout.h"

namespace hgrid {
namespace bench {

/// Names of the workloads whose boxes are spread evenly. All parts of the benchmark that use boxes run them.
///
/// - uniform: cubes with edges of 0.8 .. 1.2 m, centers in a cube of side (4n)^(1/3): about one overlap per box.
/// - mixed: cubes with log-uniform edges of 0.01 .. 10 m. Their density gives about one overlap per box.
/// - floor: cubes as in uniform, on a square of side (2n)^(1/2). 90 % are at most 0.1 m above the ground, the others at
///   most 20 m.
/// - robots: chains of 30 boxes (the last chain may be shorter) on a square of side 1.5 (n/30)^(1/2). The links of a
///   robot share the motion of its base and sway relative to each other.
const std::vector<std::string>& evenWorkloads();

/// Names of the workloads whose boxes are spread unevenly or have very different edges. Unless noted otherwise, the
/// boxes are cubes with edges of 0.8 .. 1.2 m.
///
/// - heaps2, heaps64: 2 or 64 heaps, each like uniform, at random places in a cube of 10 km.
/// - fleet: robots as above, 50 robots per hall of 40 m x 25 m. The halls are at random places of a square of 5 km, on
///   16 floors.
/// - strays: like uniform, but 5 % of the boxes are anywhere within 100 km of the origin on each axis.
/// - diagonal: cubes in a row along (1, 1, 1), one every 0.35 m.
/// - levy: cubes at the stops of a random flight. Its steps are at least 0.5 m long; the density of their length l is
///   proportional to l^-2.5.
/// - rods: boxes 5 .. 15 m long and 5 .. 20 cm thick, along a random axis: about one overlap per box.
/// - giants: like uniform, but the edges of every thousandth box are 2 .. 10 % of the world's side.
/// - torus: boxes with edges of 2 .. 10 m on the surface of a torus with radii of 10 km and 1 km: few overlaps.
/// - tower: 25 floors, 4 m apart. Each is like the workload floor, but its boxes are at most 3 m above it.
/// - line: cubes in a row along z, one every 0.7 m.
/// - decades: cubes around the origin. Their density falls by a factor of 10^6 while the radius grows by 10^2.
/// - onecell: plates and needles of length 1 m within 10 m, so thin that there are at most ten overlaps per box.
/// - sizes: like mixed, but with log-uniform edges of 10^-3 .. 10^3 m.
const std::vector<std::string>& unevenWorkloads();

/// Returns whether this is the name of one of the evenWorkloads().
bool isEven(const std::string& workload);

/// Returns the n boxes of a workload, the same ones in every call.
/// @throws std::invalid_argument if there is no such workload.
Layout layoutOf(const std::string& workload, std::size_t n);

}  // namespace bench
}  // namespace hgrid
