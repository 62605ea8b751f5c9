// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/exactness/bullet_double.h"

#include <dlfcn.h>

#include <stdexcept>

namespace hgrid {
namespace bench {
namespace {

/// Loads the module. RTLD_DEEPBIND: its names refer to its own libraries.
decltype(&hgridBenchBulletDouble) loaded() {
  void* const module = dlopen(HGRID_BENCH_BULLET_DOUBLE_FILE, RTLD_NOW | RTLD_LOCAL | RTLD_DEEPBIND);
  void* const function = module ? dlsym(module, "hgridBenchBulletDouble") : nullptr;
  if (!function) throw std::runtime_error(dlerror());
  return reinterpret_cast<decltype(&hgridBenchBulletDouble)>(function);
}

}  // namespace

ExactnessAnswer measureWithBulletDouble(const test::Case& placed) {
  static const auto measure = loaded();
  ExactnessAnswer answer;
  measure(placed, answer);
  return answer;
}

}  // namespace bench
}  // namespace hgrid
