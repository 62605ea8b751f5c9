// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/peers/factories.h"

namespace hgrid {
namespace bench {
namespace {

constexpr std::size_t kThousand = 1000, kTenThousand = 10000, kHundredThousand = 100000, kMillion = 1000000;

std::vector<PeerKind> all() {
  std::vector<PeerKind> kinds;
  if (canSweep()) kinds.push_back({"sweep", "avx2", kMillion, kMillion, makeSweep});
  kinds.push_back({"brute force", "default", kTenThousand, kThousand, makeBrute});
#ifdef HGRID_BENCH_FCL
  kinds.push_back({"FCL DynamicAABBTree", "default", kMillion, kMillion, makeFclTree});
  kinds.push_back({"FCL DynamicAABBTree_Array", "default", kMillion, 0, makeFclTreeArray});
  kinds.push_back({"FCL SSaP", "default", kTenThousand, 0, makeFclSSaP});
  kinds.push_back({"FCL SaP", "default", kTenThousand, 0, makeFclSaP});
  kinds.push_back({"FCL SpatialHash", "default", kTenThousand, 0, makeFclSpatialHash});
#endif
#ifdef HGRID_BENCH_BULLET
  kinds.push_back({"Bullet dbvt", "default", kHundredThousand, kHundredThousand, makeBulletDbvt});
  kinds.push_back({"Bullet AxisSweep3", "default", kTenThousand, kTenThousand, makeBulletAxisSweep});
#endif
#ifdef HGRID_BENCH_ODE
  kinds.push_back({"ODE hash space", "default", kTenThousand, 0, makeOdeHash});
  kinds.push_back({"ODE SAP space", "default", kHundredThousand, 0, makeOdeSap});
#endif
#ifdef HGRID_BENCH_CGAL
  kinds.push_back({"CGAL box_self_intersection_d", "default", kHundredThousand, 0, makeCgal});
#endif
#ifdef HGRID_BENCH_BOOST
  kinds.push_back({"Boost R-tree", "default", kMillion, kMillion, makeBoostRtree});
#endif
#ifdef HGRID_BENCH_EMBREE
  kinds.push_back({"Embree rtcCollide", "default", kMillion, kMillion, makeEmbree});
#endif
#ifdef HGRID_BENCH_BOX3D
  kinds.push_back({"Box3D", "default", kMillion, kMillion, makeBox3d});
#endif
#ifdef HGRID_BENCH_JOLT
  kinds.push_back({"Jolt", "default", kMillion, kMillion, makeJolt});
#endif
  return kinds;
}

}  // namespace

const std::vector<PeerKind>& peers() {
  static const std::vector<PeerKind> kinds = all();
  return kinds;
}

const std::vector<std::string>& missingPeers() {
  static const std::vector<std::string> names{
#ifndef HGRID_BENCH_FCL
      "FCL",
#endif
#ifndef HGRID_BENCH_BULLET
      "Bullet",
#endif
#ifndef HGRID_BENCH_BULLET_DOUBLE
      "Bullet with doubles",
#endif
#ifndef HGRID_BENCH_CCD
      "libccd",
#endif
#ifndef HGRID_BENCH_ODE
      "ODE",
#endif
#ifndef HGRID_BENCH_CGAL
      "CGAL",
#endif
#ifndef HGRID_BENCH_BOOST
      "Boost.Geometry",
#endif
#ifndef HGRID_BENCH_EMBREE
      "Embree",
#endif
#ifndef HGRID_BENCH_BOX3D
      "Box3D (--box3d DIR)",
#endif
#ifndef HGRID_BENCH_JOLT
      "Jolt (--jolt DIR)",
#endif
#ifndef HGRID_BENCH_OCTOMAP
      "OctoMap",
#endif
  };
  return names;
}

}  // namespace bench
}  // namespace hgrid
