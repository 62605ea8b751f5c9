// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "processor_time.h"

#include <time.h>
#include <unistd.h>

#include <fstream>
#include <string>

namespace hgrid {
namespace bench {

double processorTime(pid_t process) {
  clockid_t clock{};
  timespec time{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &time) != 0) return 0.0;
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double processorTimeOfAll() {
  std::ifstream file("/proc/stat");
  std::string skipped;
  file >> skipped;
  double sum = 0.0;
  for (const bool busy : {true, true, true, false, false, true, true, true}) {  // skips idle time and waits for disks
    double ticks = 0.0;
    file >> ticks;
    if (busy) sum += ticks;
  }
  return sum / static_cast<double>(sysconf(_SC_CLK_TCK));
}

}  // namespace bench
}  // namespace hgrid
