// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "processor_time.h"

#include <unistd.h>

#include <fstream>
#include <sstream>
#include <string>

namespace hgrid {
namespace bench {

double processorTime(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string text;
  std::getline(file, text);
  std::istringstream fields(text.substr(text.rfind(')') + 1));  // the program's name before ')' may contain spaces
  std::string skipped;
  for (int field = 3; field < 14; ++field) fields >> skipped;
  double user = 0.0, system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
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
