// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <string>
#include <vector>

#include "bench/workload/layout.h"

namespace hgrid {
namespace bench {

/// Names of the workloads whose boxes are spread evenly; every part of the benchmark runs them.
///
/// - uniform: cubes of edge 0.8 .. 1.2 m, centers in a cube of side (4n)^(1/3): about one overlap per box.
/// - mixed: cubes with edges log-uniform over 0.01 .. 10 m, the cube's side chosen for about as many overlaps.
/// - floor: cubes as in uniform over a square of side (2n)^(1/2), 90 % within 0.1 m of the ground, the others up to 20.
/// - robots: chains of 30 boxes (the last one what is left) on a square of side 1.5 (n/30)^(1/2); links share the
///   motion of their base and sway against each other.
const std::vector<std::string>& evenWorkloads();

/// Names of the workloads whose boxes are spread unevenly, or have very different edges. Cubes have edges of 0.8 .. 1.2
/// m unless said otherwise.
///
/// - heaps2, heaps64: so many heaps, each like uniform, at random places in a cube of 10 km.
/// - fleet: robots as above, 50 in a hall of 40 m x 25 m, halls at random places and on 16 floors of a site of 5 km.
/// - strays: uniform, but 5 % of the boxes are anywhere within 100 km of the origin on each axis.
/// - diagonal: cubes in a row along (1, 1, 1), one every 0.35 m.
/// - levy: cubes at the stops of a random flight, whose steps l >= 0.5 m have a density that falls as l^-2.5.
/// - rods: 5 .. 15 m long and 5 .. 20 cm thick, along a random axis: about one overlap per box.
/// - giants: uniform, but every thousandth box has edges of 2 .. 10 % of the world's side.
/// - torus: boxes of edges 2 .. 10 m on the surface of a torus of radii 10 km and 1 km: few overlaps.
/// - tower: 25 floors 4 m apart, each like floor, its boxes up to 3 m above it.
/// - line: cubes in a row along z, one every 0.7 m.
/// - decades: cubes around the origin, at a density that falls by six decades over two decades of the radius.
/// - onecell: plates and needles of length 1 m within 10 m, so thin that there are at most ten overlaps per box.
/// - sizes: cubes as in mixed, with edges log-uniform over 10^-3 .. 10^3 m.
const std::vector<std::string>& unevenWorkloads();

bool isEven(const std::string& workload);

/// The n boxes of a workload, always the same ones. @throws std::invalid_argument if there is no such workload.
Layout layoutOf(const std::string& workload, std::size_t n);

}  // namespace bench
}  // namespace hgrid
