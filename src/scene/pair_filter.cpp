// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/scene/pair_filter.h"

#include <map>

#include "hgrid_proximity/scene/name.h"

namespace hgrid {

namespace {

struct Type {
  BodyKind kind;
  Mobility mobility;
};

std::uint8_t numberOf(const Type& type) {
  return static_cast<std::uint8_t>(2 * static_cast<int>(type.kind) + static_cast<int>(type.mobility));
}

Type typeOf(std::size_t number) { return {static_cast<BodyKind>(number / 2), static_cast<Mobility>(number % 2)}; }

bool exists(const PairKinds& kinds, const Type& a, const Type& b, bool same_robot) {
  if (a.mobility == Mobility::fixed && b.mobility == Mobility::fixed) return false;
  if (a.kind == BodyKind::link && b.kind == BodyKind::link) return same_robot ? kinds.self : kinds.robot_robot;
  if (a.kind == BodyKind::link || b.kind == BodyKind::link) {
    const BodyKind other = a.kind == BodyKind::link ? b.kind : a.kind;
    return other == BodyKind::map ? kinds.robot_map : kinds.robot_obstacle;
  }
  return kinds.moving_obstacle;
}

}  // namespace

PairFilter::PairFilter(const std::vector<Body>& bodies, PairKinds kinds, std::vector<AllowedPattern> patterns)
    : words_((patterns.size() + 63) / 64) {
  for (std::size_t a = 0; a < kTypes; ++a) {
    for (std::size_t b = 0; b < kTypes; ++b) {
      for (const bool same_robot : {false, true})
        exists_[same_robot][a][b] = exists(kinds, typeOf(a), typeOf(b), same_robot);
    }
  }
  std::map<std::string, std::uint32_t> robots;
  as_first_.resize(bodies.size() * words_);
  as_second_.resize(bodies.size() * words_);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = bodies[i];
    Subject subject;
    subject.type = numberOf({body.kind, body.mobility});
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

bool PairFilter::patternMatches(std::uint32_t first, std::uint32_t second) const {
  for (std::size_t word = 0; word < words_; ++word) {
    const std::size_t i = first * words_ + word, j = second * words_ + word;
    if (((as_first_[i] & as_second_[j]) | (as_second_[i] & as_first_[j])) != 0) return true;
  }
  return false;
}

}  // namespace hgrid
