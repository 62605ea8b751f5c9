// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#ifdef __x86_64__
#include <xmmintrin.h>
#else
#include <cfenv>
#endif

namespace hgrid {

/// While an object of this class exists, its thread uses the default floating-point environment: round to nearest, keep
/// denormals.
///
/// The promise "no missed pair" depends on this environment, and another library in the process may have changed it.
/// Some queries take only about 1 us, so the cost of this class matters. On x86-64, it changes only the control
/// register of SSE (MXCSR), because SSE computes all operations on type double, and only if that register is not the
/// default.
class DefaultFloatEnvironment {
 public:
  DefaultFloatEnvironment(const DefaultFloatEnvironment&) = delete;
  DefaultFloatEnvironment& operator=(const DefaultFloatEnvironment&) = delete;

#ifdef __x86_64__
  DefaultFloatEnvironment() : before_(_mm_getcsr()) {
    if ((before_ & ~kFlags) != kDefault) _mm_setcsr(kDefault);
  }
  ~DefaultFloatEnvironment() {
    if ((before_ & ~kFlags) != kDefault) _mm_setcsr(before_);
  }

 private:
  static constexpr unsigned kDefault = 0x1f80;  // MXCSR: round to nearest, denormals kept, no exception traps
  static constexpr unsigned kFlags = 0x3f;      // MXCSR: bits that record past exceptions; ignored
  const unsigned before_;
#else
  DefaultFloatEnvironment() {
    std::fegetenv(&before_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~DefaultFloatEnvironment() { std::fesetenv(&before_); }

 private:
  std::fenv_t before_;
#endif
};

}  // namespace hgrid
