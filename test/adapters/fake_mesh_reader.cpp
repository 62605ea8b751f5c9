// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// A mesh reader that does what its file name says instead of reading. Copied by mesh_helper_test.cpp under
// names like `hang`; `replay` writes the bytes of the file beside it, `drip` one at a time.
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
  const std::string deed = self.substr(self.rfind('/') + 1);
  if (deed == "silent") return 0;
  if (deed == "fail") return 1;
  if (deed == "crash") std::raise(SIGSEGV);
  if (deed == "abort") std::abort();
  if (deed == "hang") sleepForever();
  if (deed == "hang_mute") {  // closes its output and lives on
    close(1);
    sleepForever();
  }
  if (deed == "hang_deaf") {  // cannot be asked to end
    std::signal(SIGTERM, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);
    sleepForever();
  }
  if (deed == "flood") {
    for (;;) put(std::string(1 << 16, 'x'));
  }
  if (deed == "replay" || deed == "drip") {
    std::FILE* file = std::fopen((self + ".out").c_str(), "rb");
    if (!file) return 4;
    const bool drips = deed == "drip";  // a byte now and then: each one in time, all of them never
    std::size_t count = 0;
    while ((count = std::fread(buffer, 1, drips ? 1 : sizeof buffer, file)) > 0) {
      put(std::string(buffer, count));
      if (drips) usleep(20000);
    }
    return 0;
  }
  return 5;
}
