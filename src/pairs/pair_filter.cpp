// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/pairs/pair_filter.h"

#include <algorithm>
#include <map>
#include <utility>

#include "bodies/name_index.h"

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
    return hasCells(other) ? kinds.robot_map : kinds.robot_obstacle;
  }
  const auto moving_obstacle = [](const Type& type) {
    return countsAsObstacle(type.kind) && type.mobility == Mobility::moving;
  };
  // A moving map and a fixed obstacle make no pair, because the cells of the map contain the fixed obstacles too.
  return kinds.moving_obstacle && (moving_obstacle(a) || moving_obstacle(b));
}

std::uint64_t keyOf(std::uint32_t first, std::uint32_t second) {
  return std::uint64_t{std::min(first, second)} << 32 | std::max(first, second);
}

}  // namespace

PairFilter::PairFilter(const BodyList& bodies, PairKinds kinds, std::vector<PairRule> rules)
    : rules_(std::move(rules)) {
  for (std::size_t a = 0; a < kTypes; ++a) {
    for (std::size_t b = 0; b < kTypes; ++b) {
      for (const bool same_robot : {false, true})
        exists_[same_robot][a][b] = exists(kinds, typeOf(a), typeOf(b), same_robot);
    }
  }
  listRules();
  fillSubjects(bodies);
  if (rules_.empty()) return;
  const NameIndex names(bodies);
  fillNamed(names);
  matchGlobs(names);
}

void PairFilter::fillSubjects(const BodyList& bodies) {
  std::map<std::string, std::uint32_t> robots;
  subjects_.reserve(bodies.size());
  for (const Body& body : bodies) {
    Subject subject;
    subject.type = numberOf({body.kind, body.mobility});
    subject.link = body.link;
    if (body.kind == BodyKind::link) {
      subject.robot = robots.emplace(body.robot, static_cast<std::uint32_t>(robots.size())).first->second;
    }
    if (body.kind == BodyKind::obstacle && !body.group.empty()) {  // no name of a robot contains a slash
      const auto next = static_cast<std::uint32_t>(robots.size());
      subject.robot = robots.emplace("obstacle/" + body.group, next).first->second;
    }
    if (body.links) {
      if (matrices_.empty() || matrices_.back() != body.links) matrices_.push_back(body.links);
      subject.matrix = static_cast<std::uint32_t>(matrices_.size() - 1);
      subject.allowed = body.links->allowedWith(body.link);
    }
    subjects_.push_back(subject);
  }
  as_first_.resize(bodies.size() * words_);
  as_second_.resize(bodies.size() * words_);
}

/// Fills verdicts_ and glob_rules_.
void PairFilter::listRules() {
  for (std::uint32_t rule = 0; rule < rules_.size(); ++rule) {
    verdicts_.push_back(rules_[rule].allowed ? rules_[rule].origin : Origin::none);
    if (isGlob(rules_[rule].first) || isGlob(rules_[rule].second)) glob_rules_.push_back(rule);
  }
  words_ = (glob_rules_.size() + 63) / 64;
}

/// Fills named_: finds the two bodies of each rule that has two names without globs.
void PairFilter::fillNamed(const NameIndex& names) {
  for (std::uint32_t rule = 0; rule < rules_.size(); ++rule) {
    const PairRule& r = rules_[rule];
    if (isGlob(r.first) || isGlob(r.second)) continue;
    const std::uint32_t first = names.find(r.first), second = names.find(r.second);
    if (first == NameIndex::kNone || second == NameIndex::kNone) continue;  // the missing body may be added later
    subjects_[first].ruled |= kByName;
    subjects_[second].ruled |= kByName;
    named_.push_back({keyOf(first, second), rule});
  }
  std::sort(named_.begin(), named_.end(), [](const NamedPair& a, const NamedPair& b) {
    return a.bodies != b.bodies ? a.bodies < b.bodies : a.rule > b.rule;
  });
}

/// Sets the bits in as_first_ and as_second_ for the bodies in `names`: one bit for each glob that matches the body.
void PairFilter::matchGlobs(const NameIndex& names) {
  std::vector<std::uint32_t> found;
  const auto note = [&](const std::string& glob, std::size_t bit, std::vector<std::uint64_t>& sets) {
    names.matching(glob, found);
    for (const std::uint32_t body : found) {
      sets[body * words_ + bit / 64] |= std::uint64_t{1} << (bit % 64);
      subjects_[body].ruled |= kByGlob;
    }
  };
  for (std::size_t bit = 0; bit < glob_rules_.size(); ++bit) {
    if (glob_rules_[bit] == kNoRule) continue;
    note(rules_[glob_rules_[bit]].first, bit, as_first_);
    note(rules_[glob_rules_[bit]].second, bit, as_second_);
  }
}

/// Copies the bit sets of the bodies that another filter knows. Both filters must have the same glob_rules_.
/// @param known  for each body: its index in the other filter, or kUnknown
void PairFilter::copySets(const PairFilter& from, const std::vector<std::uint32_t>& known) {
  for (std::size_t body = 0; body < known.size(); ++body) {
    if (known[body] == kUnknown) continue;
    std::copy_n(&from.as_first_[known[body] * words_], words_, &as_first_[body * words_]);
    std::copy_n(&from.as_second_[known[body] * words_], words_, &as_second_[body * words_]);
    subjects_[body].ruled |= from.subjects_[known[body]].ruled & kByGlob;
  }
}

/// Returns NameMatches::globs for this filter.
NameMatches::Globs PairFilter::globs() const {
  NameMatches::Globs globs;
  globs.reserve(glob_rules_.size());
  for (const std::uint32_t rule : glob_rules_) {
    if (rule == kNoRule) {
      globs.emplace_back();
    } else {
      globs.emplace_back(rules_[rule].first, rules_[rule].second);
    }
  }
  return globs;
}

/// Sets the bit sets of a body to those of its name. The globs must be those of this filter.
/// @returns false if `from` does not contain the name
bool PairFilter::copyMatch(const NameMatches& from, const std::string& name, std::uint32_t body) {
  const auto found = std::lower_bound(from.names.begin(), from.names.end(), name);
  if (found == from.names.end() || *found != name) return false;
  const std::size_t source = static_cast<std::size_t>(found - from.names.begin()) * words_, target = body * words_;
  for (std::size_t word = 0; word < words_; ++word) {
    as_first_[target + word] = from.as_first[source + word];
    as_second_[target + word] = from.as_second[source + word];
    if ((as_first_[target + word] | as_second_[target + word]) != 0) subjects_[body].ruled |= kByGlob;
  }
  return true;
}

/// Sets the bit sets of the bodies that are not known, as far as `matches` contain their names.
/// @returns the indices of the other bodies that are not known
std::vector<std::uint32_t> PairFilter::copyMatches(const std::vector<NameMatches>& matches, const BodyList& bodies,
                                                   const std::vector<std::uint32_t>& known) {
  const NameMatches::Globs present = matches.empty() ? NameMatches::Globs() : globs();
  std::vector<const NameMatches*> usable;
  for (const NameMatches& one : matches) {
    if (one.globs == present) usable.push_back(&one);
  }
  std::vector<std::uint32_t> others;
  for (std::uint32_t body = 0; body < known.size(); ++body) {
    if (known[body] != kUnknown) continue;
    const auto has_name = [&](const NameMatches* one) { return copyMatch(*one, bodies[body].name, body); };
    if (std::none_of(usable.begin(), usable.end(), has_name)) others.push_back(body);
  }
  return others;
}

NameMatches PairFilter::match(std::vector<std::string> names) const {
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  BodyList bodies;
  bodies.reserve(names.size());
  for (const std::string& name : names) {
    Body body;
    body.name = name;
    bodies.push_back(std::make_shared<const Body>(std::move(body)));
  }
  PairFilter matched = forBodies(bodies, std::vector<std::uint32_t>(names.size(), kUnknown));
  return {globs(), std::move(names), std::move(matched.as_first_), std::move(matched.as_second_)};
}

PairFilter PairFilter::forBodies(const BodyList& bodies, const std::vector<std::uint32_t>& known,
                                 const std::vector<NameMatches>& matches) const {
  PairFilter next;
  next.exists_ = exists_;
  next.rules_ = rules_;
  next.verdicts_ = verdicts_;
  next.glob_rules_ = glob_rules_;
  next.words_ = words_;
  next.fillSubjects(bodies);
  if (rules_.empty()) return next;
  next.fillNamed(NameIndex(bodies));
  if (words_ == 0) return next;
  next.copySets(*this, known);
  next.matchGlobs(NameIndex(bodies, next.copyMatches(matches, bodies, known)));
  return next;
}

PairFilter PairFilter::without(const std::vector<bool>& gone) const {
  PairFilter rest = *this;
  rest.rules_.clear();
  rest.verdicts_.clear();
  std::vector<std::uint32_t> new_rule(rules_.size(), kNoRule);  // for each old rule: its index in `rest`
  for (std::size_t rule = 0; rule < rules_.size(); ++rule) {
    if (gone[rule]) continue;
    new_rule[rule] = static_cast<std::uint32_t>(rest.rules_.size());
    rest.rules_.push_back(rules_[rule]);
    rest.verdicts_.push_back(verdicts_[rule]);
  }
  for (Subject& subject : rest.subjects_) subject.ruled = 0;
  rest.named_.clear();
  for (const NamedPair& pair : named_) {
    if (gone[pair.rule]) continue;
    rest.named_.push_back({pair.bodies, new_rule[pair.rule]});
    for (const std::uint64_t body : {pair.bodies >> 32, pair.bodies & 0xffffffff})
      rest.subjects_[body].ruled |= kByName;
  }
  std::vector<std::uint64_t> staying(words_);
  for (std::size_t bit = 0; bit < glob_rules_.size(); ++bit) {
    std::uint32_t& rule = rest.glob_rules_[bit];
    if (rule != kNoRule) rule = new_rule[rule];
    if (rule != kNoRule) staying[bit / 64] |= std::uint64_t{1} << (bit % 64);
  }
  for (std::size_t i = 0; i < as_first_.size(); ++i) {
    rest.as_first_[i] &= staying[i % words_];
    rest.as_second_[i] &= staying[i % words_];
    if ((rest.as_first_[i] | rest.as_second_[i]) != 0) rest.subjects_[i / words_].ruled |= kByGlob;
  }
  return rest;
}

/// Returns the index of the rule that takes precedence for a pair, or kNoRule if no rule matches the pair.
std::uint32_t PairFilter::ruleOf(std::uint32_t first, std::uint32_t second) const {
  const std::uint64_t key = keyOf(first, second);
  const auto named = std::lower_bound(named_.begin(), named_.end(), key,
                                      [](const NamedPair& pair, std::uint64_t wanted) { return pair.bodies < wanted; });
  if (named != named_.end() && named->bodies == key) return named->rule;
  for (std::size_t word = words_; word-- > 0;) {
    const std::size_t i = first * words_ + word, j = second * words_ + word;
    const std::uint64_t both = (as_first_[i] & as_second_[j]) | (as_second_[i] & as_first_[j]);
    if (both != 0) return glob_rules_[64 * word + 63 - static_cast<std::size_t>(__builtin_clzll(both))];
  }
  return kNoRule;
}

PairDecision PairFilter::decision(std::uint32_t first, std::uint32_t second) const {
  PairDecision result;
  result.origin = origin(first, second);
  result.allowed = result.origin != Origin::none;
  if (result.origin == Origin::self || result.origin == Origin::kind) return result;
  result.rule = ruleOf(first, second);
  if (result.rule != kNoRule) {
    result.origin = rules_[result.rule].origin;
    result.reason = rules_[result.rule].reason;
    return result;
  }
  if (result.origin == Origin::group) result.reason = "obstacles of one group move together";
  const Subject &a = subjects_[first], &b = subjects_[second];
  if (a.robot != b.robot || a.allowed == nullptr) return result;
  if (const LinkMatrix::Tag* tag = matrices_[a.matrix]->tag(a.link, b.link)) {
    result.origin = Origin::srdf;
    result.reason = tag->reason;
  } else if (result.origin == Origin::srdf) {
    result.reason = "disable_default_collisions";
  } else if (result.origin == Origin::adjacent) {
    result.reason = matrices_[a.matrix]->adjacencyReason(a.link, b.link);
  } else if (result.origin == Origin::rigid) {
    result.reason = "they move as one";
  }
  return result;
}

void PairFilter::appendKey(std::uint32_t body, std::vector<std::uint64_t>& key) const {
  const Subject& subject = subjects_[body];
  key.push_back(subject.type);
  key.push_back(isObstacle(subject.type) ? subject.robot : kNoRobot);  // the group
  key.push_back((subject.ruled & kByName) != 0 ? body : kNoRule);  // a body that a rule names needs a key of its own
  for (const auto* sets : {&as_first_, &as_second_}) {
    const auto begin = sets->begin() + static_cast<std::ptrdiff_t>(body * words_);
    key.insert(key.end(), begin, begin + static_cast<std::ptrdiff_t>(words_));
  }
}

/// Returns a selection of the bodies. If a pair of any bodies is reported, and if these are not two links of one robot,
/// then a pair of selected bodies is reported too. For each key (see appendKey()), one or two bodies are selected. The
/// second one is outside the robot of the first one.
std::vector<std::uint32_t> PairFilter::representatives() const {
  struct Chosen {
    std::uint32_t robot;  // robot of the first chosen body
    bool two;             // whether a second body was chosen
  };
  std::map<std::vector<std::uint64_t>, Chosen> chosen;  // the chosen bodies of each key
  std::vector<std::uint32_t> result;
  for (std::uint32_t i = 0; i < subjects_.size(); ++i) {
    const Subject& subject = subjects_[i];
    std::vector<std::uint64_t> key;
    appendKey(i, key);
    const auto [found, is_new] = chosen.emplace(std::move(key), Chosen{subject.robot, false});
    const bool stranger = !is_new && (found->second.robot != subject.robot || subject.robot == kNoRobot);
    const bool second = stranger && !std::exchange(found->second.two, true);
    if (is_new || second) result.push_back(i);
  }
  return result;
}

bool PairFilter::reportsAny() const {
  const std::size_t count = subjects_.size();
  for (std::size_t i = 0; i < count; ++i) {  // a quick check of a few pairs nearly always finds a reported pair
    for (const std::size_t j : {(i + 1) % count, (i + count / 2) % count}) {
      if (!allowed(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j))) return true;
    }
  }
  const std::vector<std::uint32_t> chosen = representatives();
  for (const std::uint32_t i : chosen) {
    for (const std::uint32_t j : chosen) {
      if (!allowed(i, j)) return true;
    }
  }
  // Within a robot, the model's matrix can decide differently for each pair of links.
  std::map<std::uint32_t, std::vector<std::uint32_t>> robots;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (subjects_[i].robot != kNoRobot && !isObstacle(subjects_[i].type)) robots[subjects_[i].robot].push_back(i);
  }
  for (const auto& robot : robots) {
    for (const std::uint32_t i : robot.second) {
      for (const std::uint32_t j : robot.second) {
        if (!allowed(i, j)) return true;
      }
    }
  }
  return false;
}

std::size_t PairFilter::bytes() const {
  std::size_t bytes = sizeof(*this) + subjects_.capacity() * sizeof(Subject) +
                      matrices_.capacity() * sizeof(std::shared_ptr<const LinkMatrix>) +
                      verdicts_.capacity() * sizeof(Origin) + named_.capacity() * sizeof(NamedPair) +
                      glob_rules_.capacity() * sizeof(std::uint32_t) +
                      (as_first_.capacity() + as_second_.capacity()) * sizeof(std::uint64_t);
  for (const PairRule& rule : rules_) {
    bytes += sizeof(PairRule) + rule.first.capacity() + rule.second.capacity() + rule.reason.capacity();
  }
  return bytes;
}

bool silencesAll(const BodyList& bodies, const PairKinds& kinds, const PairFilter& filter) {
  return !filter.rules().empty() && !filter.reportsAny() && PairFilter(bodies, kinds, {}).reportsAny();
}

}  // namespace hgrid
