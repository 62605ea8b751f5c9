// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <cmath>

#include "bench/workload/layouts.h"
#include "bench/workload/random_points.h"

namespace hgrid {
namespace bench {

using Eigen::Vector3f;

Layout heapsLayout(std::size_t n, std::size_t heaps) {
  Layout layout;
  layout.side = 10e3;
  const auto heap_side = static_cast<float>(usualSide(double(n) / double(heaps)));
  const Region space{Vector3f::Zero(), Vector3f::Constant(static_cast<float>(layout.side) - heap_side)};
  Random random(4);
  for (std::size_t i = 0; i < heaps; ++i) {
    const Vector3f corner = randomPoint(random, space);
    layout.addRegion(corner, corner + Vector3f::Constant(heap_side));
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Region& region = layout.regions[random.below(heaps)];
    const double edge = usualEdge(random);
    layout.addCube(edge, randomPoint(random, region), region);
  }
  return layout;
}

Layout straysLayout(std::size_t n) {
  constexpr float kFar = 100e3f;  // [m]
  Layout layout;
  layout.side = 2.0 * double(kFar);
  const auto side = static_cast<float>(usualSide(0.95 * double(n)));
  const Region& heap = layout.addRegion(Vector3f::Zero(), Vector3f::Constant(side));
  const Region& space = layout.addRegion(Vector3f::Constant(-kFar), Vector3f::Constant(kFar));
  Random random(1);
  for (std::size_t i = 0; i < n; ++i) {
    const Region& region = random.below(20) == 0 ? space : heap;
    const double edge = usualEdge(random);
    layout.addCube(edge, randomPoint(random, region), region);
  }
  return layout;
}

Layout decadesLayout(std::size_t n) {
  // The radius is log-uniform over two decades. Therefore the density falls by a factor of 10^3 per decade. The
  // integral of the squared density gives n / (3 pi (2 ln 10)^2 r^3) overlaps per box, where r is the smallest radius.
  constexpr double kPi = 3.14159265358979, kDecades = 2.0;
  const double smallest = std::cbrt(double(n) / (3.0 * kPi * std::pow(kDecades * std::log(10.0), 2)));
  Layout layout;
  layout.side = 2.0 * smallest * std::pow(10.0, kDecades);
  const Region& sway = layout.addRegion(Vector3f::Constant(-0.5f), Vector3f::Constant(0.5f));
  Random random(1);
  for (std::size_t i = 0; i < n; ++i) {
    const auto edge = static_cast<float>(usualEdge(random));
    const double radius = smallest * std::pow(10.0, kDecades * random.uniform(0.0, 1.0));
    layout.addSwaying(Vector3f::Constant(edge), edge, radius * direction(random), sway);
  }
  return layout;
}

}  // namespace bench
}  // namespace hgrid
