// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "src/node/threads/realtime.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace test {
namespace {

/// Calls makeRealtime() in a child process that has no right to a real-time priority.
/// @param may_lock  whether it has the right to lock memory
/// @returns the sentence of the refusal, followed by the scheduling policy; empty: nothing was refused
std::string refusalWithoutPriority(bool may_lock) {
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) return "no pipe";
  const pid_t child = fork();
  if (child == 0) {
    const rlimit no_priority{0, 0};
    setrlimit(RLIMIT_RTPRIO, &no_priority);
    std::string sentence;
    if (geteuid() == 0 && setuid(65534) != 0) sentence = "the user could not be changed";
    try {
      makeRealtime(20, may_lock);
    } catch (const Refusal& refusal) {
      sentence += refusal.what();
      int policy = -1;
      sched_param settings{};
      pthread_getschedparam(pthread_self(), &policy, &settings);
      sentence += policy == SCHED_OTHER ? " [usual policy]" : " [other policy]";
    }
    const ssize_t written = write(pipe_ends[1], sentence.data(), sentence.size());
    _exit(written == static_cast<ssize_t>(sentence.size()) ? 0 : 1);
  }
  close(pipe_ends[1]);
  std::string sentence;
  char buffer[1000];
  for (ssize_t size = 0; (size = read(pipe_ends[0], buffer, sizeof buffer)) > 0;) {
    sentence.append(buffer, static_cast<std::size_t>(size));
  }
  close(pipe_ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  return sentence;
}

TEST(Realtime, WithoutTheRightToLockMemoryIsRefusedAndChangesNothing) {
  EXPECT_EQ(
      refusalWithoutPriority(false),
      "~realtime is 20, but the process may not lock all of its memory (memlock unlimited); allow it for the user of "
      "the node in /etc/security/limits.conf and log in again, or set ~realtime to 0. The node goes on without it "
      "[usual policy]");
}

TEST(Realtime, WithoutTheRightToThePriorityIsRefusedAndChangesNothing) {
  EXPECT_EQ(
      refusalWithoutPriority(true),
      "~realtime is 20, but the tick thread may not have this priority (rtprio 20): Operation not permitted; allow it "
      "for the user of the node in /etc/security/limits.conf and log in again, or set ~realtime to 0. The node goes "
      "on without it [usual policy]");
}

}  // namespace
}  // namespace test
}  // namespace hgrid
