// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/process/housekeeping.h"

#include <cmath>
#include <utility>

#include "node/health/guarded.h"

namespace hgrid {
namespace {

constexpr double kLongestPeriod = 0.25;  // [s] longest time between two checks for due chores

}  // namespace

ChoreList::ChoreList(std::vector<Chore> chores, Ledger& ledger) : ledger_(ledger) {
  for (Chore& chore : chores) plan_.push_back({std::move(chore)});
}

void ChoreList::doDue(Time now) {
  for (Planned& planned : plan_) {
    if (now < planned.next) continue;
    planned.next = now + planned.chore.pause;
    guarded(ledger_, planned.chore.fault, [&] { planned.chore.act(now); });
  }
}

void ChorePace::setRate(double rate) {
  const double between_runs = 1.0 / rate;
  period_ = between_runs / std::ceil(between_runs / kLongestPeriod);
  pause_ = std::chrono::nanoseconds(std::llround(1e9 * (between_runs - 0.5 * period_)));
}

bool ChorePace::takeDue(Time now) {
  if (last_ && now < *last_ + pause_) return false;
  last_ = now;
  return true;
}

Housekeeping::Housekeeping(const ros::NodeHandle& node, double period, ChoreList chores)
    : node_(node), period_(period), chores_(std::move(chores)) {}

void Housekeeping::setPeriod(double period) {
  period_ = period;
  timer_.setPeriod(ros::WallDuration(period));
}

void Housekeeping::start() {
  timer_ = node_.createSteadyTimer(ros::WallDuration(period_), [this](const ros::SteadyTimerEvent&) {
    chores_.doDue(std::chrono::steady_clock::now());
  });
}

}  // namespace hgrid
