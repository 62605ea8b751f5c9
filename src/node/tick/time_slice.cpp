// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tick/time_slice.h"

#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

namespace hgrid {
namespace {

constexpr std::uint64_t kSlice = 100000;  // [ns] the shortest slice that Linux accepts

/// The scheduling attributes of a thread, as Linux expects them (sched_setattr(2)). The C library of older systems does
/// not declare them.
struct Attributes {
  std::uint32_t size = sizeof(Attributes);
  std::uint32_t policy = SCHED_OTHER;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t runtime = 0, deadline = 0, period = 0;  // [ns]
};
static_assert(sizeof(Attributes) == 48, "the layout that Linux expects");

}  // namespace

void askForShortTimeSlices() {
  Attributes attributes;
  if (syscall(SYS_sched_getattr, 0, &attributes, sizeof attributes, 0) != 0 || attributes.policy != SCHED_OTHER) return;
  attributes.runtime = kSlice;
  syscall(SYS_sched_setattr, 0, &attributes, 0);  // a failure does no harm
}

}  // namespace hgrid
