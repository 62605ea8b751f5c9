// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>

#include "geometry/four_lanes.h"

namespace hgrid {

/// Bound of the rounding errors of a distance of two boxes or balls, relative to all lengths from which it is computed.
inline constexpr float kTiltedRounding = 2e-6f;

// The functions below exist for one number and for a vector of four numbers.
inline float least(float a, float b) { return a < b ? a : b; }
inline float greatest(float a, float b) { return a > b ? a : b; }
inline float squareRoot(float value) { return std::sqrt(value); }
inline float absolute(float value) { return std::abs(value); }
inline Four absolute(Four value) { return greatest(value, -value); }

/// A box around a shape, at any orientation, in floats. `Number` is float, or Four for four boxes.
template <class Number>
struct TiltedBox {
  Number axes[3][3];     // axes[i][k]: component k of axis i, a unit vector
  Number center[3];      // [m]
  Number half[3];        // [m] half of the lengths along the axes, grown by the rounding errors of all numbers
  bool is_ball = false;  // whether the shape is inside the ball around `center` with the radius half[0]
};

/// How far two boxes, or the balls in them, are surely apart.
template <class Number>
struct Separation {
  Number along_faces;  // [m] lower bound of the distance; for boxes, from the faces only; negative: minus a bound of
                       // their overlap
  Number along_edges;  // positive: an axis perpendicular to two edges separates the boxes; not a length
};

/// Computes a dot product.
template <class Number>
Number dotOf(const Number (&a)[3], const Number (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Returns how far [m] a box reaches from its center along a coordinate axis. @param k  the axis: 0, 1 or 2
template <class Number>
Number reachAlong(const TiltedBox<Number>& box, std::size_t k) {
  return absolute(box.axes[0][k]) * box.half[0] + absolute(box.axes[1][k]) * box.half[1] +
         absolute(box.axes[2][k]) * box.half[2];
}

/// Returns a lower bound of the distance [m] of two balls. Negative: minus a bound of their overlap.
template <class Number>
Number gapOfBalls(const TiltedBox<Number>& a, const TiltedBox<Number>& b) {
  const Number x = b.center[0] - a.center[0], y = b.center[1] - a.center[1], z = b.center[2] - a.center[2];
  return squareRoot(x * x + y * y + z * z) * (1.0f - kTiltedRounding) -
         (a.half[0] + b.half[0]) * (1.0f + kTiltedRounding);
}

/// Returns a lower bound of the distance [m] of a ball and a box. Negative: minus a bound of their overlap.
template <class Number>
Number gapOfBallAndBox(const TiltedBox<Number>& ball, const TiltedBox<Number>& box) {
  Number way[3], beyond[3], outside[3];  // `beyond` and `outside`: how far the center is beyond the faces of the box
  for (int k = 0; k < 3; ++k) way[k] = ball.center[k] - box.center[k];
  for (int i = 0; i < 3; ++i) {
    beyond[i] = absolute(dotOf(box.axes[i], way)) - box.half[i];
    outside[i] = greatest(beyond[i], Number{});
  }
  const Number inside = least(greatest(greatest(beyond[0], beyond[1]), beyond[2]), Number{});
  const Number size =
      absolute(way[0]) + absolute(way[1]) + absolute(way[2]) + box.half[0] + box.half[1] + box.half[2] + ball.half[0];
  return squareRoot(dotOf(outside, outside)) + inside - ball.half[0] - size * kTiltedRounding;
}

/// Separates two boxes by the 15 axes of the separating axis test (Ericson 2005, section 4.4.1). Rounding only makes
/// the results smaller. For a ball, its distance is computed instead.
/// @param up_to  [m] If along_faces is larger than this, along_edges is not computed and is negative. Only for single
///   boxes; Four ignores it.
template <class Number>
Separation<Number> separationOf(const TiltedBox<Number>& a, const TiltedBox<Number>& b,
                                [[maybe_unused]] const Number& up_to) {
  if (a.is_ball) return {b.is_ball ? gapOfBalls(a, b) : gapOfBallAndBox(a, b), Number{}};
  if (b.is_ball) return {gapOfBallAndBox(b, a), Number{}};
  Number turn[3][3], share[3][3], way[3], along[3];  // in the frame of `a`: rotation of `b`, its center
  for (int k = 0; k < 3; ++k) way[k] = b.center[k] - a.center[k];
  for (int i = 0; i < 3; ++i) {
    along[i] = dotOf(a.axes[i], way);
    for (int k = 0; k < 3; ++k) {
      turn[i][k] = dotOf(a.axes[i], b.axes[k]);
      share[i][k] = absolute(turn[i][k]);
    }
  }
  const Number size = absolute(way[0]) + absolute(way[1]) + absolute(way[2]) + a.half[0] + a.half[1] + a.half[2] +
                      b.half[0] + b.half[1] + b.half[2];
  const Number rounding = size * kTiltedRounding;
  Separation<Number> result{absolute(along[0]) - a.half[0] - dotOf(share[0], b.half), size * -1.0f};
  for (int i = 0; i < 3; ++i) {
    const Number gap_of_a = absolute(along[i]) - a.half[i] - dotOf(share[i], b.half);
    const Number gap_of_b = absolute(dotOf(b.axes[i], way)) - b.half[i] - share[0][i] * a.half[0] -
                            share[1][i] * a.half[1] - share[2][i] * a.half[2];
    result.along_faces = greatest(result.along_faces, greatest(gap_of_a, gap_of_b));
  }
  result.along_faces = result.along_faces - rounding;
  if constexpr (std::is_same_v<Number, float>) {
    if (result.along_faces > up_to) return result;
  }
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3, last = (i + 2) % 3;
    for (int k = 0; k < 3; ++k) {
      const int k_next = (k + 1) % 3, k_last = (k + 2) % 3;
      const Number apart = absolute(along[last] * turn[next][k] - along[next] * turn[last][k]);
      const Number reach = a.half[next] * share[last][k] + a.half[last] * share[next][k] +
                           b.half[k_next] * share[i][k_last] + b.half[k_last] * share[i][k_next];
      result.along_edges = greatest(result.along_edges, apart - reach);
    }
  }
  result.along_edges = result.along_edges - rounding;
  return result;
}

}  // namespace hgrid
