// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/envelope/answer_tick.h"

#include <chrono>
#include <utility>

#include "hgrid_proximity/refusal.h"

namespace hgrid {

AnswerTick::AnswerTick(std::shared_ptr<const Tick> tick) : tick_(std::move(tick)) {
  if (tick_) age_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - tick_->made.steady).count();
}

const Snapshot& AnswerTick::snapshot() const {
  if (!tick_)
    throw Refusal(Code::not_ready, "there is no world yet: the node has not computed its first tick; ask again");
  if (!tick_->snapshot) throw Refusal(Code::not_ready, "there is no world yet: " + tick_->not_ready.front());
  return *tick_->snapshot;
}

std::string AnswerTick::whyOutdated() const {
  const double valid_for = tick_->settings->params.valid_for;
  if (age_ <= valid_for) return "";
  return "the newest tick is " + secondsText(age_) + " old; ticks are valid for " + text(valid_for) + " s (~valid_for)";
}

}  // namespace hgrid
