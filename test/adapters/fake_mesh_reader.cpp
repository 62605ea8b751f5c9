// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// A fake mesh reader. The name of its own file decides what it does instead of reading a mesh. mesh_helper_test.cpp
// copies it under names such as `hang`. Under the name `replay` it writes all bytes of the file `replay.out`, which is
// in the same folder. Under the name `drip` it writes the bytes of `drip.out` one at a time.
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace {

void put(const std::string& bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = write(1, bytes.data() + done, bytes.size() - done);
    if (count <= 0) std::exit(1);
    done += static_cast<std::size_t>(count);
  }
}

[[noreturn]] void sleepForever() {
  for (;;) pause();
}

}  // namespace

int main() {
  char buffer[4096];
  const ssize_t size = readlink("/proc/self/exe", buffer, sizeof buffer);
  if (size <= 0) return 3;
  const std::string self(buffer, static_cast<std::size_t>(size));
  const std::string behavior = self.substr(self.rfind('/') + 1);
  if (behavior == "silent") return 0;
  if (behavior == "fail") return 1;
  if (behavior == "crash") std::raise(SIGSEGV);
  if (behavior == "abort") std::abort();
  if (behavior == "hang") sleepForever();
  if (behavior == "hang_mute") {  // closes its output, but does not end
    close(1);
    sleepForever();
  }
  if (behavior == "hang_deaf") {  // ignores the signals that ask it to end
    std::signal(SIGTERM, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    sleepForever();
  }
  if (behavior == "flood") {
    for (;;) put(std::string(1 << 16, 'x'));
  }
  if (behavior == "replay" || behavior == "drip") {
    std::FILE* file = std::fopen((self + ".out").c_str(), "rb");
    if (!file) return 4;
    const bool drips = behavior == "drip";  // one byte every 20 ms; the whole file takes too long
    std::size_t count = 0;
    while ((count = std::fread(buffer, 1, drips ? 1 : sizeof buffer, file)) > 0) {
      put(std::string(buffer, count));
      if (drips) usleep(20000);
    }
    return 0;
  }
  return 5;
}
