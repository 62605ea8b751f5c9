// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/process/shutdown.h"

#include <ros/init.h>
#include <unistd.h>

#include <csignal>

namespace hgrid {
namespace {

constexpr unsigned kGrace = 2;  // [s] time for an orderly shutdown
constexpr char kGaveUp[] =
    "proximity_node: the shutdown took longer than 2 s; the process ends now, perhaps without unregistering the node\n";

volatile std::sig_atomic_t g_ending = 0;

// Both handlers only call functions that a signal handler may call. ros::requestShutdown() only sets a flag.

void onEndSignal(int) {
  if (g_ending != 0) return;  // a second signal does not prolong the grace period
  g_ending = 1;
  ros::requestShutdown();
  alarm(kGrace);
}

void onAlarm(int) {
  if (::write(STDERR_FILENO, kGaveUp, sizeof(kGaveUp) - 1) < 0) {
    // If even this text cannot be written, nothing else can report it.
  }
  _exit(0);
}

void handle(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;  // otherwise system calls of other libraries could fail because of the signal
  sigaction(number, &action, nullptr);
}

bool isIgnored(int number) {
  struct sigaction now {};
  return sigaction(number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

}  // namespace

void shutDownOnSignals() {
  handle(SIGALRM, onAlarm);
  handle(SIGINT, onEndSignal);
  handle(SIGTERM, onEndSignal);
  if (!isIgnored(SIGHUP)) handle(SIGHUP, onEndSignal);
}

bool endRequested() { return g_ending != 0; }

}  // namespace hgrid
