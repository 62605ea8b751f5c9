// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>

#ifdef __aarch64__
#include <arm_neon.h>
#endif

namespace hgrid {

/// Returns std::max(a, b) without a branch. If one of them is NaN, it returns `a`.
inline double greaterOf(double a, double b) {
#ifdef __aarch64__  // gcc turns std::max into a branch
  const float64x1_t first = vdup_n_f64(a), second = vdup_n_f64(b);
  return vget_lane_f64(vbsl_f64(vclt_f64(first, second), second, first), 0);
#else
  return std::max(a, b);
#endif
}

}  // namespace hgrid
