// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "bench/workload/layout.h"

namespace hgrid {
namespace bench {

// One function per workload, each described in workloads.h. A function returns n boxes, the same ones in every call.

// cubes.cpp: cubes spread evenly over a cube or a square.
Layout uniformLayout(std::size_t n);
Layout mixedLayout(std::size_t n);
Layout sizesLayout(std::size_t n);
Layout floorLayout(std::size_t n);
Layout towerLayout(std::size_t n);
Layout giantsLayout(std::size_t n);

// robots.cpp: chains of boxes that share the motion of a base.
Layout robotsLayout(std::size_t n);
Layout fleetLayout(std::size_t n);

// heaps.cpp: dense groups of boxes in a large and nearly empty space.
Layout heapsLayout(std::size_t n, std::size_t heaps);
Layout straysLayout(std::size_t n);
Layout decadesLayout(std::size_t n);

// curves.cpp: boxes along lines and on a surface.
Layout lineLayout(std::size_t n);
Layout diagonalLayout(std::size_t n);
Layout levyLayout(std::size_t n);
Layout torusLayout(std::size_t n);

// thin.cpp: boxes that are much longer than they are thick.
Layout rodsLayout(std::size_t n);
Layout oneCellLayout(std::size_t n);

}  // namespace bench
}  // namespace hgrid
