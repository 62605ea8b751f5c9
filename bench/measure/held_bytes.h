// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <malloc.h>

namespace hgrid {
namespace bench {

/// Returns the number of bytes that this process has allocated with malloc and has not freed.
inline double heldBytes() {
#if defined(__GLIBC__) && (__GLIBC__ > 2 || __GLIBC_MINOR__ >= 33)
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
#else
  const struct mallinfo info = mallinfo();  // older glibc: the counters are ints that overflow
  return static_cast<double>(static_cast<unsigned>(info.uordblks)) +
         static_cast<double>(static_cast<unsigned>(info.hblkhd));
#endif
}

}  // namespace bench
}  // namespace hgrid
