// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "bench/exactness/exactness_peer.h"

/// The only function of the module with Bullet's library of doubles. That library has the same names as the one of
/// floats, which this program is linked with. Therefore the module is loaded when it is needed, and apart from all
/// else.
extern "C" void hgridBenchBulletDouble(const hgrid::test::Case& placed, hgrid::bench::ExactnessAnswer& answer);
