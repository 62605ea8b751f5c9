// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/exactness/exactness_peer.h"
#include "hgrid_proximity/narrow/core_narrow_phase.h"

namespace hgrid {
namespace bench {
namespace {

ExactnessAnswer measureWithHgrid(const test::Case& placed) {
  static const std::shared_ptr<NarrowPhase> narrow_phase = makeCoreNarrowPhase();
  const auto first = narrow_phase->solidOf(placed.first_shape), second = narrow_phase->solidOf(placed.second_shape);
  const PlacedSolid a{*first, placed.world_from_first, 0.0}, b{*second, placed.world_from_second, 0.0};
  const Proximity found = narrow_phase->measure(a, b, std::numeric_limits<double>::infinity());
  ExactnessAnswer answer;
  answer.given = found.status == Measure::apart || found.status == Measure::contact;
  answer.touches = found.status == Measure::contact;
  answer.distance = found.distance;
  answer.lower_bound = answer.touches ? 0.0 : found.lower_bound;
  answer.normal = found.normal;
  if (answer.touches) {
    const Contact contact = narrow_phase->measureContact(a, b);
    answer.depth = contact.depth;
    answer.normal = contact.normal;
  }
  return answer;
}

}  // namespace

std::vector<ExactnessPeer> exactnessPeers() {
  std::vector<ExactnessPeer> peers{{"hgrid", measureWithHgrid}};
#ifdef HGRID_BENCH_FCL
  peers.push_back({"FCL, GST_LIBCCD", measureWithFclLibccd});
  peers.push_back({"FCL, GST_INDEP", measureWithFclIndep});
#endif
#ifdef HGRID_BENCH_BULLET_DOUBLE
  peers.push_back({"Bullet, double", measureWithBulletDouble});
#endif
#ifdef HGRID_BENCH_BULLET
  peers.push_back({"Bullet, float", measureWithBulletFloat});
#endif
#ifdef HGRID_BENCH_CCD
  peers.push_back({"libccd, GJK and EPA", measureWithCcdGjk});
  peers.push_back({"libccd, MPR", measureWithCcdMpr});
#endif
#ifdef HGRID_BENCH_ODE
  peers.push_back({"ODE", measureWithOde, false});
#endif
  return peers;
}

}  // namespace bench
}  // namespace hgrid
