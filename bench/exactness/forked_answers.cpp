// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "bench/exactness/forked_answers.h"

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <new>
#include <stdexcept>

namespace hgrid {
namespace bench {
namespace {

constexpr unsigned kPatience = 2;  // [s] for one pair

/// Memory that the child processes and this one share: the number of pairs that were asked about, and the answers.
class Shared {
 public:
  explicit Shared(std::size_t count) : bytes_(sizeof(std::size_t) + count * sizeof(ExactnessAnswer)) {
    memory_ = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory_ == MAP_FAILED) throw std::runtime_error("no memory for answers");
    new (memory_) std::size_t(0);
    for (std::size_t i = 0; i < count; ++i) new (&answer(i)) ExactnessAnswer;
  }
  ~Shared() { munmap(memory_, bytes_); }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;

  volatile std::size_t& asked() { return *static_cast<std::size_t*>(memory_); }
  ExactnessAnswer& answer(std::size_t i) {
    return reinterpret_cast<ExactnessAnswer*>(static_cast<std::size_t*>(memory_) + 1)[i];
  }

 private:
  std::size_t bytes_;
  void* memory_;
};

[[noreturn]] void askInChild(const ExactnessPeer& peer, const std::vector<test::Case>& pairs, Shared& shared) {
  if (!std::freopen("/dev/null", "w", stderr)) _exit(1);  // FCL and ODE print a line for each failed search
  while (shared.asked() < pairs.size()) {
    const std::size_t i = shared.asked();
    shared.asked() = i + 1;
    if (!peer.knows(pairs[i])) continue;
    alarm(kPatience);
    try {
      shared.answer(i) = peer.measure(pairs[i]);
    } catch (const std::exception&) {
      shared.answer(i) = {};
    }
  }
  _exit(0);
}

}  // namespace

std::vector<ExactnessAnswer> forkedAnswers(const ExactnessPeer& peer, const std::vector<test::Case>& pairs) {
  Shared shared(pairs.size());
  while (shared.asked() < pairs.size()) {
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("no process for " + peer.name);
    if (child == 0) askInChild(peer, pairs, shared);
    waitpid(child, nullptr, 0);
  }
  std::vector<ExactnessAnswer> answers;
  for (std::size_t i = 0; i < pairs.size(); ++i) answers.push_back(shared.answer(i));
  return answers;
}

}  // namespace bench
}  // namespace hgrid
