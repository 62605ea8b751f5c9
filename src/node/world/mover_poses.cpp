// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/mover_poses.h"

#include <algorithm>
#include <numeric>

#include "node/world/find_trouble.h"

namespace hgrid {

MoverPoses::MoverPoses(const Params& params, const TfIntake& intake, Scene& scene, Movers& movers, Ledger& ledger)
    : limits_{params.late_after, params.stale_after, params.lost_after},
      intake_(intake),
      scene_(scene),
      movers_(movers),
      ledger_(ledger),
      frames_(intake, limits_, params.max_sync_wait) {}

Time MoverPoses::update(const Moment& now, bool clock_frozen, Tick& tick) {
  planChains(tick.world_frame);
  frames_.look(now);
  cohorts_.clear();
  for (const std::size_t i : active_) updateOne(i, clock_frozen, tick);
  active_.erase(std::remove_if(active_.begin(), active_.end(), [this](std::size_t i) { return isAtRest(i); }),
                active_.end());
  return frames_.tickTime();
}

void MoverPoses::planChains(const std::string& world_frame) {
  const bool is_planned = planned_revision_ == movers_.revision() && !frames_.stale();
  // If movers were only added, the others that are at rest stay there.
  const bool only_added = planned_revision_ != kNever && movers_.onlyAddedSince(planned_revision_) && !frames_.stale();
  if (settled_revision_ != intake_.staticRevision() || !only_added) {
    unsettleAll();
  } else {
    active_.reserve(active_.size() + movers_.size() - planned_);
    for (std::size_t i = planned_; i < movers_.size(); ++i) active_.push_back(i);
  }
  planned_ = movers_.size();
  if (is_planned) return;
  std::vector<std::string> frames;
  frames.reserve(movers_.size());
  for (const Mover& mover : movers_.all()) frames.push_back(mover.frame);
  planned_revision_ = kNever;  // until the plan is complete
  frames_.plan(world_frame, std::move(frames));
  planned_revision_ = movers_.revision();
}

/// Lets all settled movers be computed again, because a new chain or a new static transform can move them.
void MoverPoses::unsettleAll() {
  active_.resize(movers_.size());  // may throw, so it comes first
  std::iota(active_.begin(), active_.end(), std::size_t{0});
  for (Mover& mover : movers_.all()) mover.settled = false;
  settled_revision_ = intake_.staticRevision();
}

void MoverPoses::updateOne(std::size_t index, bool clock_frozen, Tick& tick) {
  Mover& mover = movers_[index];
  const ChainState& chain = frames_.chain(index);
  const bool is_static =
      chain.connected && !chain.moves && chain.refused == nullptr && chain.contested == TfIntake::kNone;
  if (mover.begins_lost && !mover.given_up) placeOnce(index);
  if (mover.given_up || mover.begins_lost) {
    updateGivenUp(mover, tick);
    return;
  }
  if (mover.settled && is_static) return;
  mover.trouble = frames_.troubleOf(index);
  mover.conflict = chain.conflict;
  if (mover.pose.settled() && (!chain.connected || chain.moves)) {
    mover.pose.unsettle(frames_.tickTimeBefore(), frames_.readingBefore());
    setStamp(mover);
  }
  if (const auto found = frames_.find(index, mover.pose)) place(mover, *found, chain.moves);
  if (!mover.pose.exists() && !frames_.unknownFrame(index).empty()) {
    tick.missing_frames.push_back(frames_.unknownFrame(index));
  }
  mover.settled = is_static && !mover.trouble;
  setState(mover, judge(mover, chain, clock_frozen), chain.connected ? chain.period : 0.0);
  appendTroubles(mover, tick);
}

/// Places a mover that is then given up. Does nothing while its frame has no pose.
void MoverPoses::placeOnce(std::size_t index) {
  Mover& mover = movers_[index];
  mover.trouble = frames_.troubleOf(index);
  const auto found = frames_.find(index, mover.pose);
  if (!found) return;
  place(mover, *found, frames_.chain(index).moves);
  mover.pose.unsettle(found->stamp, frames_.reading());
  mover.given_up = mover.pose.exists();
}

/// Lets the pose of the mover grow old where it is.
void MoverPoses::updateGivenUp(Mover& mover, Tick& tick) {
  mover.settled = false;
  if (mover.pose.settled()) {
    mover.pose.unsettle(frames_.tickTimeBefore(), frames_.readingBefore());
    setStamp(mover);
  }
  setState(mover, Freshness::lost, 0.0);
  appendTroubles(mover, tick);
}

/// Places all bodies of the mover. If the scene refuses the pose of one of them, none is moved.
void MoverPoses::place(Mover& mover, const FramePoses::Found& found, bool moves) {
  try {
    const Pose world_from_frame = found.world_from_frame.pose();
    placed_.clear();
    for (std::size_t i = mover.first; i < mover.last; ++i) {
      const Member& member = movers_.members()[i];
      placed_.push_back(member.at_frame ? world_from_frame : world_from_frame * member.frame_from_body);
      scene_.checkPlace(member.body, placed_.back());
    }
    for (std::size_t i = mover.first; i < mover.last; ++i) {
      scene_.place(movers_.members()[i].body, placed_[i - mover.first], found.stamp);
    }
    if (moves) {
      mover.pose.renew(found.stamp, found.born);
    } else {
      mover.pose.settle(found.stamp);
    }
  } catch (const Refusal& refusal) {
    ledger_.refuse("pose.refused", refusal);
    mover.trouble = refusal;
  }
}

Freshness MoverPoses::judge(const Mover& mover, const ChainState& chain, bool clock_frozen) const {
  PoseCircumstances circumstances;
  circumstances.reading = frames_.reading();
  circumstances.tick_time = frames_.tickTime();
  circumstances.period = chain.period;
  if (chain.connected) circumstances.chain = chain.worst;
  circumstances.refused = mover.trouble && mover.trouble->code() != Code::unknown_frame;
  circumstances.clock_frozen = clock_frozen && !mover.settled;  // a settled mover needs no new data
  return judgePose(mover.pose, circumstances, limits_);
}

void MoverPoses::setState(const Mover& mover, Freshness state, double period) {
  for (std::size_t i = mover.first; i < mover.last; ++i) {
    const BodyId body = movers_.members()[i].body;
    std::uint32_t cohort = 0;  // settled bodies are always in cohort 0
    if (!mover.settled) {
      const Time stamp = scene_.poseOf(body).stamp;
      cohort = cohorts_.emplace(stamp, static_cast<std::uint32_t>(cohorts_.size() + 1)).first->second;
    }
    scene_.setState(body, state, mover.pose.age(frames_.reading()), cohort, period);
  }
}

void MoverPoses::appendTroubles(const Mover& mover, Tick& tick) const {
  for (std::size_t i = mover.first; i < mover.last; ++i) {
    const BodyId body = movers_.members()[i].body;
    const BodyPose& pose = scene_.poseOf(body);
    if (pose.state == Freshness::fresh && !mover.conflict) continue;
    tick.troubles.push_back(troubleOf(scene_.body(body), pose, mover, tick.world_frame));
  }
}

void MoverPoses::restamp(const Moment& now, bool lost) {
  for (Mover& mover : movers_.all()) {
    if (!mover.pose.exists() || mover.pose.settled()) continue;
    mover.pose.restamp(intake_.ages().read(now), now.ros, lost);
    setStamp(mover);
  }
}

/// Gives the bodies of the mover the stamp of its pose. Their poses do not change.
void MoverPoses::setStamp(const Mover& mover) {
  for (std::size_t i = mover.first; i < mover.last; ++i) {
    const BodyId body = movers_.members()[i].body;
    const Pose same = scene_.poseOf(body).world_from_body;
    scene_.place(body, same, mover.pose.stamp());
  }
}

}  // namespace hgrid
