// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "geometry/arc_tangent.h"

#include <cmath>
#include <limits>

namespace hgrid {

double arcTangent(double y, double x) {
  const double across = std::abs(y), along = std::abs(x);
  const bool is_steep = across > along;
  const double greater = is_steep ? across : along, less = is_steep ? along : across;
  if (std::isnan(x) || std::isnan(y)) return std::numeric_limits<double>::quiet_NaN();
  double slope = greater > 0.0 ? less / greater : 0.0;  // 0 .. 1
  if (std::isinf(less)) slope = 1.0;
  // Halving the angle twice leaves a slope of at most 0.2, for which the series has 12 terms.
  for (int i = 0; i < 2; ++i) slope /= 1.0 + std::sqrt(1.0 + slope * slope);
  const double square = slope * slope;
  double series = 0.0;
  for (int term = 25; term >= 3; term -= 2) series = square * ((term % 4 == 1 ? 1.0 : -1.0) / term + series);
  double angle = 4.0 * (slope + slope * series);
  if (is_steep) angle = M_PI_2 - angle;
  if (std::signbit(x)) angle = M_PI - angle;
  return std::copysign(angle, y);
}

}  // namespace hgrid
