// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/housekeeping.h"

#include <utility>

#include "node/services/guarded.h"

namespace hgrid {

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

Housekeeping::Housekeeping(const ros::NodeHandle& node, double period, ChoreList chores)
    : node_(node), period_(period), chores_(std::move(chores)) {}

void Housekeeping::start() {
  timer_ = node_.createSteadyTimer(ros::WallDuration(period_), [this](const ros::SteadyTimerEvent&) {
    chores_.doDue(std::chrono::steady_clock::now());
  });
}

}  // namespace hgrid
