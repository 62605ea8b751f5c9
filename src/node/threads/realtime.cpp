// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/threads/realtime.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

[[noreturn]] void refuse(int priority, const std::string& why) {
  throw Refusal(
      Code::resource_denied,
      "~realtime is " + std::to_string(priority) + ", but " + why +
          "; allow it for the user of the node in /etc/security/limits.conf and log in again, or set ~realtime to "
          "0. The node goes on without it");
}

}  // namespace

bool mayLockAllMemory() {
  rlimit limit{};
  return geteuid() == 0 || (getrlimit(RLIMIT_MEMLOCK, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY);
}

void makeRealtime(int priority, bool may_lock) {
  if (!may_lock) refuse(priority, "the process may not lock all of its memory (memlock unlimited)");
  sched_param settings{};
  settings.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &settings);
  if (error != 0) {
    refuse(priority, std::string("the tick thread may not have this priority (rtprio ") + std::to_string(priority) +
                         "): " + std::strerror(error));
  }
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) return;
  const std::string why = std::strerror(errno);
  settings.sched_priority = 0;
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &settings);
  refuse(priority, "the memory of the process could not be locked: " + why);
}

}  // namespace hgrid
