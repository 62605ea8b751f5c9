// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/world/movers.h"

#include <algorithm>
#include <utility>

namespace hgrid {
namespace {

Member memberAt(const Pose& frame_from_body) {
  return {{}, frame_from_body.matrix() == Pose::Identity().matrix(), frame_from_body};
}

/// Makes room for one more element, so that the next push_back() does not allocate.
template <class T>
void makeRoom(std::vector<T>& elements) {
  if (elements.size() == elements.capacity()) elements.reserve(std::max<std::size_t>(8, 2 * elements.size()));
}

}  // namespace

void Movers::Change::add(const std::string& frame, const SourceId& source, Body body, const Pose& frame_from_body) {
  Mover mover{frame, source};
  mover.first = mover.last = members_.size();
  movers_.push_back(std::move(mover));
  join(std::move(body), frame_from_body);
}

void Movers::Change::reserve(std::size_t bodies) {
  in_.reserve(in_.size() + bodies);
  movers_.reserve(movers_.size() + bodies);
  members_.reserve(members_.size() + bodies);
}

void Movers::Change::join(Body body, const Pose& frame_from_body) {
  in_.push_back(std::move(body));
  members_.push_back(memberAt(frame_from_body));
  movers_.back().last = members_.size();
}

void Movers::add(const SourceId& source, Body body) {
  makeRoom(movers_);
  makeRoom(members_);
  Mover mover{body.frame, source};
  mover.first = members_.size();
  mover.last = mover.first + 1;
  Member member = memberAt(body.frame_from_body);
  member.body = scene_.add(std::move(body));
  // The code below does not allocate, so it cannot fail.
  members_.push_back(member);
  movers_.push_back(std::move(mover));
  ++revision_;
}

void Movers::giveUp(const std::set<std::string>& names) noexcept {
  for (Mover& mover : movers_) {
    if (mover.source.kind == SourceKind::obstacle && names.count(mover.source.name) != 0) mover.given_up = true;
  }
  ++revision_;
}

void Movers::beginLost(const std::set<std::string>& names) noexcept {
  for (Mover& mover : movers_) {
    if (mover.source.kind == SourceKind::obstacle && names.count(mover.source.name) != 0) mover.begins_lost = true;
  }
}

Movers::Change Movers::changeWithout(const std::function<bool(const SourceId&)>& chosen) const {
  Change change;
  change.movers_.reserve(movers_.size());
  change.members_.reserve(members_.size());
  for (const Mover& mover : movers_) {
    const auto first = members_.begin() + static_cast<std::ptrdiff_t>(mover.first);
    const auto last = members_.begin() + static_cast<std::ptrdiff_t>(mover.last);
    if (chosen(mover.source)) {
      for (auto member = first; member != last; ++member) change.out_.push_back(member->body);
      continue;
    }
    change.movers_.push_back(mover);
    change.movers_.back().first = change.members_.size();
    change.members_.insert(change.members_.end(), first, last);
    change.movers_.back().last = change.members_.size();
  }
  return change;
}

void Movers::exchange(Change change) {
  const std::vector<BodyId> ids = scene_.exchange(change.out_, std::move(change.in_));
  // The code below does not allocate, so it cannot fail.
  auto member = change.members_.end() - static_cast<std::ptrdiff_t>(ids.size());
  for (const BodyId id : ids) (member++)->body = id;
  movers_.swap(change.movers_);
  members_.swap(change.members_);
  ++revision_;
}

}  // namespace hgrid
