// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/broadphase/isa.h"

#include <initializer_list>

#include "broadphase/kernels/kernels.h"

namespace hgrid {

const char* name(Isa isa) {
  static constexpr const char* kNames[] = {"portable", "sse2", "avx2", "avx512", "neon"};
  return kNames[static_cast<int>(isa)];
}

bool isSupported(Isa isa) {
#ifdef HGRID_X86_KERNELS
  if (isa == Isa::sse2) return __builtin_cpu_supports("sse2");
  if (isa == Isa::avx2)
    return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi");
  if (isa == Isa::avx512) {
    return isSupported(Isa::avx2) && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
           __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
  }
#endif
#ifdef HGRID_NEON_KERNELS
  if (isa == Isa::neon) return true;  // every 64-bit ARM processor supports NEON
#endif
  return isa == Isa::portable;
}

Isa bestIsa() {
  static const Isa best = [] {
    for (const Isa isa : {Isa::avx512, Isa::avx2, Isa::sse2, Isa::neon}) {
      if (isSupported(isa)) return isa;
    }
    return Isa::portable;
  }();
  return best;
}

namespace kernels {

const Kernels& of(Isa isa) {
#ifdef HGRID_X86_KERNELS
  if (isa == Isa::sse2) return sse2Kernels();
  if (isa == Isa::avx2) return avx2Kernels();
  if (isa == Isa::avx512) return avx512Kernels();
#endif
#ifdef HGRID_NEON_KERNELS
  if (isa == Isa::neon) return neonKernels();
#endif
  return portableKernels();
}

}  // namespace kernels
}  // namespace hgrid
