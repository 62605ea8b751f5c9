// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/tick/tick_history.h"

#include <ros/console.h>

#include <cmath>
#include <string>
#include <utility>

#include "hgrid_proximity/refusal.h"
#include "node/health/guarded.h"
#include "node/time/ros_time.h"

namespace hgrid {
namespace {

HistoryLimits limitsOf(const Params& params) {
  HistoryLimits limits;
  limits.span = Time(std::llround(1e9 * params.history));
  limits.bytes = static_cast<std::size_t>(params.history_bytes);
  return limits;
}

std::string stampText(Time stamp) { return text(seconds(stamp)) + " s"; }

/// Returns what answers need of a tick besides its snapshot.
std::shared_ptr<const Tick> withoutSnapshot(const Tick& tick) {
  const auto note = std::make_shared<Tick>();
  note->settings = tick.settings;
  note->world_frame = tick.world_frame;
  note->made = tick.made;
  note->epoch = tick.epoch;
  note->unplaced = tick.unplaced;
  note->models = tick.models;
  note->robots = tick.robots;
  return note;
}

std::size_t bytesOf(const Tick& note) {
  std::size_t bytes = sizeof(Tick) + note.world_frame.capacity() + note.unplaced.capacity() * sizeof(std::string);
  for (const std::string& sentence : note.unplaced) bytes += sentence.capacity();
  return bytes;
}

}  // namespace

TickHistory::TickHistory(const Params& params, Ledger& ledger)
    : span_(params.history), bytes_(params.history_bytes), ledger_(ledger), history_(limitsOf(params)) {
  if (!(span_ > 0.0)) return;
  worker_ =
      std::make_unique<NewestOnly<bool>>([this](bool) { guarded(ledger_, "history.failed", [this] { compact(); }); });
}

TickHistory::~TickHistory() = default;

void TickHistory::see(const Tick& tick) {
  if (!worker_) return;
  const HistoryExtent kept = history_.extent();
  if (kept.ticks > 0 && kept.epoch != tick.epoch) {
    ledger_.count("history.dropped.EPOCH", kept.ticks);
    ROS_INFO_STREAM("a new epoch began, so queries cannot ask about earlier times: " << kept.ticks
                                                                                     << " past ticks were dropped");
    history_.clear();
  }
  if (!tick.snapshot) return;
  std::shared_ptr<const Tick> note = withoutSnapshot(tick);
  const std::size_t bytes = bytesOf(*note);
  history_.add(tick.snapshot, std::move(note), bytes);
  worker_->give(true);
}

void TickHistory::compact() {
  history_.compact();
  const HistoryExtent now = history_.extent();
  if (now.skipped > counted_.skipped) ledger_.count("history.skipped", now.skipped - counted_.skipped);
  if (now.dropped > counted_.dropped) {
    ledger_.count("history.dropped.LIMIT", now.dropped - counted_.dropped);
    ROS_WARN_STREAM_THROTTLE(60.0, "~history is " << text(span_) << " s, but ~limits/history_bytes, " << bytes_
                                                  << ", has room for only " << secondsText(seconds(now.end - now.begin))
                                                  << " of ticks; raise it, or lower ~history");
  }
  counted_ = now;
}

std::shared_ptr<const Tick> TickHistory::at(const ros::Time& stamp, const std::shared_ptr<const Tick>& newest) const {
  if (stamp.isZero()) return newest;
  const Time asked = fromRos(stamp), now = newest->snapshot->stamp();
  if (asked == now) return newest;
  PastTick past;
  if (asked < now) past = history_.find(asked, *newest->snapshot);
  const HistoryExtent kept = history_.extent();
  if (past.outcome == PastTick::Outcome::found) {
    const auto tick = std::make_shared<Tick>(*static_cast<const Tick*>(past.note.get()));
    tick->snapshot = past.snapshot;
    tick->history = kept;
    return tick;
  }
  const std::string skipped = past.outcome == PastTick::Outcome::skipped
                                  ? "; the tick of this time was not kept, because the computer was too busy"
                                  : "";
  const bool has_past = kept.ticks > 0 && kept.epoch == newest->epoch && kept.begin < now;
  const std::string range = has_past ? "can answer about " + stampText(kept.begin) + " to " + stampText(now)
                                     : "stores only the tick of " + stampText(now);
  throw Refusal(Code::extrapolation,
                "the query asks for time " + stampText(asked) + ", " + secondsText(std::abs(seconds(asked - now))) +
                    (asked < now ? " before" : " after") + " the newest tick" + skipped + "; the node " + range +
                    " (~history is " + text(span_) + " s); ask with such a stamp, or with 0 for now");
}

std::string agoText(const Snapshot& answered, const Snapshot& newest) {
  if (answered.sequence() == newest.sequence() && answered.epoch() == newest.epoch()) return {};
  return "at the tick of " + stampText(answered.stamp()) + ", " +
         secondsText(seconds(newest.stamp() - answered.stamp())) + " before the newest tick";
}

}  // namespace hgrid
