// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/movers.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace hgrid {
namespace {

Member memberAt(const Pose& frame_from_body) {
  return {{}, frame_from_body.matrix() == Pose::Identity().matrix(), frame_from_body};
}

/// Reserves memory for `more` further elements, so that adding them does not allocate.
template <class T>
void makeRoom(std::vector<T>& elements, std::size_t more) {
  const std::size_t needed = elements.size() + more;
  if (needed > elements.capacity()) elements.reserve(std::max({std::size_t{8}, needed, 2 * elements.size()}));
}

}  // namespace

void NewMovers::add(const std::string& frame, const SourceId& source, Body body, const Pose& frame_from_body) {
  Mover mover{frame, source};
  mover.first = mover.last = members_.size();
  movers_.push_back(std::move(mover));
  join(std::move(body), frame_from_body);
}

void NewMovers::add(const SourceId& source, Body body) {
  const std::string frame = body.frame;
  const Pose frame_from_body = body.frame_from_body;
  add(frame, source, std::move(body), frame_from_body);
}

void NewMovers::reserve(std::size_t bodies) {
  in_.reserve(in_.size() + bodies);
  movers_.reserve(movers_.size() + bodies);
  members_.reserve(members_.size() + bodies);
}

void NewMovers::join(Body body, const Pose& frame_from_body) {
  in_.push_back(std::move(body));
  members_.push_back(memberAt(frame_from_body));
  movers_.back().last = members_.size();
}

void NewMovers::prepare(const Scene& scene, const Snapshot& newest, const std::vector<std::string>& out,
                        const std::optional<std::vector<PairRule>>& rules) {
  prepared_ = scene.prepare(newest, out, std::move(in_), rules);
}

void Movers::add(const SourceId& source, Body body) {
  NewMovers coming;
  coming.add(source, std::move(body));
  exchange(nullptr, std::move(coming));
}

void Movers::giveUp(const std::set<std::string>& names) noexcept {
  if (names.empty()) return;
  for (Mover& mover : movers_) {
    if (mover.source.kind == SourceKind::obstacle && names.count(mover.source.name) != 0) mover.given_up = true;
  }
  reordered_ = ++revision_;
}

void Movers::beginLost(const std::set<std::string>& names) noexcept {
  for (Mover& mover : movers_) {
    if (mover.source.kind == SourceKind::obstacle && names.count(mover.source.name) != 0) mover.begins_lost = true;
  }
}

void Movers::exchange(const std::function<bool(const SourceId&)>& leaves, NewMovers&& coming) {
  std::vector<std::size_t> leaving;
  std::vector<BodyId> out;
  for (std::size_t i = 0; leaves && i < movers_.size(); ++i) {
    const Mover& mover = movers_[i];
    if (!leaves(mover.source)) continue;
    leaving.push_back(i);
    for (std::size_t member = mover.first; member < mover.last; ++member) out.push_back(members_[member].body);
  }
  makeRoom(movers_, coming.movers_.size());
  makeRoom(members_, coming.members_.size());
  const std::vector<BodyId> ids = coming.prepared_ ? scene_.exchangePrepared(out, std::move(*coming.prepared_))
                                                   : scene_.exchange(out, std::move(coming.in_));
  // The code below does not allocate, so it cannot fail.
  if (!leaving.empty()) remove(leaving);
  for (Mover& mover : coming.movers_) {
    mover.first += members_.size();
    mover.last += members_.size();
  }
  for (std::size_t i = 0; i < ids.size(); ++i) coming.members_[i].body = ids[i];
  std::move(coming.movers_.begin(), coming.movers_.end(), std::back_inserter(movers_));
  std::move(coming.members_.begin(), coming.members_.end(), std::back_inserter(members_));
  ++revision_;
  if (!leaving.empty()) reordered_ = revision_;
}

/// Removes movers and their members. The others keep their order. @param leaving  indices of movers, ascending
void Movers::remove(const std::vector<std::size_t>& leaving) noexcept {
  auto next = leaving.begin();
  std::size_t kept_movers = 0, kept_members = 0;
  for (std::size_t i = 0; i < movers_.size(); ++i) {
    if (next != leaving.end() && *next == i) {
      ++next;
      continue;
    }
    Mover& mover = movers_[i];
    const std::size_t first = kept_members;
    for (std::size_t member = mover.first; member < mover.last; ++member) members_[kept_members++] = members_[member];
    mover.first = first;
    mover.last = kept_members;
    if (kept_movers != i) movers_[kept_movers] = std::move(mover);
    ++kept_movers;
  }
  movers_.erase(movers_.begin() + static_cast<std::ptrdiff_t>(kept_movers), movers_.end());
  members_.erase(members_.begin() + static_cast<std::ptrdiff_t>(kept_members), members_.end());
}

}  // namespace hgrid
