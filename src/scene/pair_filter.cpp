// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/scene/pair_filter.h"

#include <map>

#include "hgrid_proximity/scene/name.h"

namespace hgrid {

PairFilter::PairFilter(const std::vector<Body>& bodies, PairKinds kinds, std::vector<AllowedPattern> patterns)
    : kinds_(kinds), words_((patterns.size() + 63) / 64) {
  std::map<std::string, std::uint32_t> robots;
  as_first_.resize(bodies.size() * words_);
  as_second_.resize(bodies.size() * words_);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    Subject subject;
    subject.kind = body.kind;
    subject.mobility = body.mobility;
    subject.link = body.link;
    subject.links = body.links.get();
    if (body.kind == BodyKind::link) {
      subject.robot = robots.emplace(body.robot, static_cast<std::uint32_t>(robots.size())).first->second;
    }
    if (body.links) matrices_.push_back(body.links);
    subjects_.push_back(subject);
    for (std::size_t k = 0; k < patterns.size(); ++k) {
      const std::uint64_t bit = std::uint64_t{1} << (k % 64);
      if (matches(patterns[k].first, body.name)) as_first_[i * words_ + k / 64] |= bit;
      if (matches(patterns[k].second, body.name)) as_second_[i * words_ + k / 64] |= bit;
    }
  }
}

bool PairFilter::kindExists(const Subject& a, const Subject& b) const {
  if (a.mobility == Mobility::fixed && b.mobility == Mobility::fixed) return false;
  if (a.kind == BodyKind::link && b.kind == BodyKind::link)
    return a.robot == b.robot ? kinds_.self : kinds_.robot_robot;
  if (a.kind == BodyKind::link || b.kind == BodyKind::link) {
    const BodyKind other = a.kind == BodyKind::link ? b.kind : a.kind;
    return other == BodyKind::map ? kinds_.robot_map : kinds_.robot_obstacle;
  }
  return kinds_.moving_obstacle;
}

bool PairFilter::patternMatches(std::uint32_t first, std::uint32_t second) const {
  for (std::size_t word = 0; word < words_; ++word) {
    const std::size_t i = first * words_ + word, j = second * words_ + word;
    if (((as_first_[i] & as_second_[j]) | (as_second_[i] & as_first_[j])) != 0) return true;
  }
  return false;
}

Origin PairFilter::origin(std::uint32_t first, std::uint32_t second) const {
  if (first == second) return Origin::self;
  const Subject &a = subjects_[first], &b = subjects_[second];
  if (!kindExists(a, b)) return Origin::kind;
  if (a.kind == BodyKind::link && b.kind == BodyKind::link && a.robot == b.robot && a.links != nullptr) {
    const Origin origin = a.links->origin(a.link, b.link);
    if (origin != Origin::none) return origin;
  }
  return patternMatches(first, second) ? Origin::parameter : Origin::none;
}

}  // namespace hgrid
