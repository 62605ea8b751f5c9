// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/measure/contestant.h"

#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>

namespace hgrid {
namespace bench {
namespace {

using Clock = std::chrono::steady_clock;

/// Pins this process to the last processor that it may use.
void pin() {
  cpu_set_t allowed, one;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
  int last = 0;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (CPU_ISSET(cpu, &allowed)) last = cpu;
  }
  CPU_ZERO(&one);
  CPU_SET(last, &one);
  sched_setaffinity(0, sizeof one, &one);
}

bool writeAll(int file, const void* data, std::size_t size) {
  const char* from = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = write(file, from, size);
    if (written <= 0) return false;
    from += written, size -= static_cast<std::size_t>(written);
  }
  return true;
}

/// Reads `size` bytes. Returns false at the end of the file or after the deadline. Null means that there is no
/// deadline.
bool readAll(int file, void* data, std::size_t size, const Clock::time_point* deadline) {
  char* to = static_cast<char*>(data);
  while (size > 0) {
    if (deadline) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(*deadline - Clock::now()).count();
      pollfd waiting{file, POLLIN, 0};
      if (left <= 0 || poll(&waiting, 1, static_cast<int>(left)) <= 0) return false;
    }
    const ssize_t got = read(file, to, size);
    if (got <= 0) return false;
    to += got, size -= static_cast<std::size_t>(got);
  }
  return true;
}

/// Main loop of the child process: reads a time budget, runs the peer, and writes the samples.
void serve(const std::function<Contestant::Play()>& make, int in, int out) {
  Contestant::Play play;
  double budget = 0.0;
  while (readAll(in, &budget, sizeof budget, nullptr)) {
    if (!play) play = make();
    const std::vector<Sample> samples = play(budget);
    const std::size_t count = samples.size();
    if (!writeAll(out, &count, sizeof count) || !writeAll(out, samples.data(), count * sizeof(Sample))) return;
  }
}

}  // namespace

Contestant::Contestant(const std::function<Play()>& make, int threads) {
  int down[2], up[2];
  if (pipe(down) != 0 || pipe(up) != 0)
    throw std::runtime_error("cannot create a pipe to the child process of a contestant");
  std::fflush(nullptr);
  child_ = fork();
  if (child_ < 0) throw std::runtime_error("cannot fork the child process of a contestant");
  if (child_ > 0) {
    close(down[0]), close(up[1]);
    to_child_ = down[1], from_child_ = up[0];
    return;
  }
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  close(down[1]), close(up[0]);
  if (threads == 1) pin();
  try {
    serve(make, down[0], up[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    _exit(1);
  }
  _exit(0);  // not exit(): the parent's exit handlers must not run in the child
}

Contestant::~Contestant() { end(status_); }

void Contestant::end(const std::string& status) {
  status_ = status;
  if (child_ < 0) return;
  close(to_child_), close(from_child_);
  kill(child_, SIGKILL);
  waitpid(child_, nullptr, 0);
  child_ = -1;
}

void Contestant::play(double budget_ms, double limit_s) {
  if (child_ < 0) return;
  const Clock::time_point deadline = Clock::now() + std::chrono::milliseconds(static_cast<long>(1e3 * limit_s));
  std::size_t count = 0;
  std::vector<Sample> samples;
  bool good =
      writeAll(to_child_, &budget_ms, sizeof budget_ms) && readAll(from_child_, &count, sizeof count, &deadline);
  if (good) {
    samples.resize(count);
    good = readAll(from_child_, samples.data(), count * sizeof(Sample), &deadline);
  }
  if (good) {
    blocks_.push_back(std::move(samples));
  } else if (Clock::now() >= deadline) {
    end("no answer in " + std::to_string(static_cast<int>(limit_s)) + " s");
  } else {
    int how = 0;
    waitpid(child_, &how, 0);
    child_ = -1;
    close(to_child_), close(from_child_);
    status_ = WIFSIGNALED(how) ? std::string("crashed: ") + strsignal(WTERMSIG(how)) : "ended with an error";
  }
}

}  // namespace bench
}  // namespace hgrid
