// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/state/state_keeper.h"

#include <ros/console.h>

#include <algorithm>
#include <map>
#include <utility>

#include "node/health/guarded.h"
#include "node/state/stored_items.h"
#include "node/world/world.h"

namespace hgrid {
namespace {

constexpr std::chrono::milliseconds kOpenPatience{3000};  // for an earlier process of this node that is about to end
constexpr std::chrono::seconds kDiskPatience{5};          // for the disk, before a change is reported as not stored
constexpr std::chrono::seconds kDiskRetry{1};
constexpr std::size_t kRoom = 1 << 20;  // [byte] the file is written anew when it is this much longer than twice its
                                        // first record

bool isFromService(const PairRule& rule) { return rule.origin == Origin::service; }

bool isSameRule(const PairRule& a, const PairRule& b) {
  return a.first == b.first && a.second == b.second && a.reason == b.reason && a.allowed == b.allowed &&
         a.ends == b.ends && a.set_by == b.set_by && a.since == b.since;
}

/// Returns a change that removes all items whose keys begin with `kind`.
WaitingChange erasureOf(const char* kind) {
  return {kind, [kind] { return StateEdit{StateEdit::Kind::erase_kind, kind, ""}; }, true};
}

std::vector<PairRule> serviceRules(const std::vector<PairRule>& all) {
  std::vector<PairRule> rules;
  std::copy_if(all.begin(), all.end(), std::back_inserter(rules), isFromService);
  return rules;
}

using Descriptions = std::map<std::string, std::shared_ptr<const RobotDescription>>;  // by keyOf()

/// Returns the descriptions that came with requests.
Descriptions textsOf(const RobotEntries& robots) {
  Descriptions texts;
  for (const auto& robot : robots) {
    const std::shared_ptr<const RobotDescription>& text = robot.second.spec->text;
    if (text) texts.emplace(keyOf(*text), text);
  }
  return texts;
}

/// Says that rules of an earlier run are in force, because they hide pairs. In rules that an earlier version of the
/// node stored, a question mark was a glob for one letter.
void warnOfRules(const std::vector<PairRule>& rules) {
  if (!rules.empty()) {
    const PairRule& first = rules.front();
    ROS_WARN(
        "%zu rules that an earlier run of the node stored are in force; the first one: '%s' with '%s', %s, set by "
        "%s%s%s",
        rules.size(), first.first.c_str(), first.second.c_str(), first.allowed ? "allowed" : "not allowed",
        first.set_by.c_str(), first.reason.empty() ? "" : ", because ", first.reason.c_str());
  }
  for (const PairRule& rule : rules) {
    if ((rule.first + rule.second).find('?') == std::string::npos) continue;
    ROS_WARN(
        "the stored rule '%s', '%s' has a question mark, which is a letter now; only * is a glob. If it was meant "
        "as a glob, clear the rule and set one with *",
        rule.first.c_str(), rule.second.c_str());
  }
}

}  // namespace

StateKeeper::StateKeeper(Commons& commons) : commons_(commons) {
  const std::string& path = commons.settings.params.state_folder;
  if (path.empty()) return;
  for (const ObstacleParams& obstacle : commons.settings.params.obstacles) configured_.insert(obstacle.body.name);
  std::string unusable;
  try {
    open();
    thread_ = std::thread([this] { run(); });
  } catch (...) {
    folder_.reset();
    unusable = caughtRefusal().what();
    restored_ = StoredWorld();
    restored_.troubles.push_back("the stored world cannot be used, and changes are not stored: " + unusable);
    ROS_ERROR("%s", restored_.troubles.back().c_str());
  }
  seen_robots_.emplace(commons.settings.params, restored_.robots);
  if (!folder_) tell(unusable);
}

/// Reads the folder.
void StateKeeper::open() {
  folder_ = std::make_unique<StateFolder>(commons_.settings.params.state_folder, kOpenPatience);
  StateFolder::Found found = folder_->read();
  items_ = std::move(found.items);
  restored_ = storedWorldOf(items_, *commons_.narrow_phase, RuleClocks::now());
  if (!found.damage.empty()) restored_.troubles.insert(restored_.troubles.begin(), found.damage);
  if (!restored_.troubles.empty()) folder_->keepDamaged();
  for (const std::string& trouble : restored_.troubles) ROS_ERROR("%s", trouble.c_str());
  for (const std::string& key : restored_.unreadable) items_.erase(key);
  seen_rules_ = restored_.rules;
  warnOfRules(restored_.rules);
}

StateKeeper::~StateKeeper() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void StateKeeper::see(World& world, const Tick& tick) {
  if (!folder_) {
    world.forgetUnsaved();
    return;
  }
  const auto failure = guarded(commons_.ledger, "state.failed", [&] {
    Changes changes = changesOf(world.obstacles());
    RobotModels robots = world.robots();
    if (robots.revision() != seen_robots_->revision()) collectRobots(robots, changes);
    std::vector<PairRule> rules;
    const bool new_structure = tick.snapshot && tick.snapshot->structure().revision != seen_structure_;
    if (new_structure) {
      rules = serviceRules(tick.snapshot->structure().filter.rules());
      if (!std::equal(rules.begin(), rules.end(), seen_rules_.begin(), seen_rules_.end(), isSameRule))
        changes.push_back({kRulesKey, [rules, clocks = RuleClocks::now()] { return editOf(rules, clocks); }});
    }
    if (!changes.empty()) add(std::move(changes));
    // The code below does not throw.
    seen_robots_->swap(robots);
    if (new_structure) {
      seen_rules_.swap(rules);
      seen_structure_ = tick.snapshot->structure().revision;
    }
    world.forgetUnsaved();
  });
  const std::lock_guard<std::mutex> lock(mutex_);
  behind_ = failure.has_value();
}

StateKeeper::Changes StateKeeper::changesOf(const ObstacleBodies& obstacles) const {
  const ObstacleBodies::Unsaved& unsaved = obstacles.unsaved();
  Changes changes;
  if (unsaved.all_removed) changes.push_back(erasureOf(kObstacleKeys));
  for (const std::string& name : unsaved.names) {
    const std::string key = kObstacleKeys + name;
    const auto found = obstacles.all().find(name);
    if (found != obstacles.all().end()) {
      changes.push_back({key, [obstacle = found->second] { return editOf(obstacle); }});
    } else {
      changes.push_back(
          {key, [name, is_configured = configured_.count(name) != 0] { return removalOf(name, is_configured); }});
    }
  }
  return changes;
}

/// Collects how the robots differ from those that were collected last.
void StateKeeper::collectRobots(const RobotModels& robots, Changes& changes) const {
  const RobotEntries configured = robots.configured();
  const RobotEntries &before = seen_robots_->all(), &after = robots.all();
  const Descriptions old = textsOf(before), present = textsOf(after);
  for (const auto& [key, text] : old) {
    if (present.count(key) == 0) changes.push_back({key, [text = text] { return removalOf(*text); }});
  }
  for (const auto& [key, text] : present) {
    if (old.count(key) == 0) changes.push_back({key, [text = text] { return editOf(*text); }});
  }
  for (const auto& [name, robot] : after) {
    const auto known = before.find(name);
    if (known != before.end() && known->second.spec == robot.spec && known->second.absent == robot.absent) continue;
    const auto usual = configured.find(name);
    if (usual != configured.end() && !robot.absent && isSame(*usual->second.spec, *robot.spec)) {
      changes.push_back({kRobotKeys + name, [name = name] { return removalOfRobot(name); }});
    } else {
      changes.push_back({kRobotKeys + name, [name = name, spec = robot.spec, absent = robot.absent] {
                           return editOfRobot(name, StoredRobot{*spec, absent});
                         }});
    }
  }
  for (const auto& robot : before) {
    const std::string& name = robot.first;
    if (after.count(name) != 0) continue;
    if (configured.count(name) != 0) {
      changes.push_back({kRobotKeys + name, [name] { return editOfRobot(name, std::nullopt); }});
    } else {
      changes.push_back({kRobotKeys + name, [name] { return removalOfRobot(name); }});
    }
  }
}

void StateKeeper::noteMap(const std::string& name, const std::optional<MapParams>& map) {
  if (!folder_) return;
  const auto is_configured = [this](const std::string& local) {
    const std::vector<MapParams>& maps = commons_.settings.params.maps;
    return std::any_of(maps.begin(), maps.end(), [&](const MapParams& one) { return one.name == local; });
  };
  Changes changes;
  if (name.empty()) {
    changes.push_back(erasureOf(kMapKeys));
    for (const MapParams& configured : commons_.settings.params.maps)
      changes.push_back({kMapKeys + configured.name, [name = configured.name] { return editOf(name, std::nullopt); }});
  } else if (map || is_configured(name)) {
    changes.push_back({kMapKeys + name, [name, map] { return editOf(name, map); }});
  } else {
    const std::string key = kMapKeys + name;
    changes.push_back({key, [key] { return StateEdit{StateEdit::Kind::erase, key, ""}; }});
  }
  add(std::move(changes));
}

/// Adds changes. If this throws, some of them may have been added; adding them again does no harm.
void StateKeeper::add(Changes changes) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (WaitingChange& change : changes) waiting_.add(std::move(change));
    ++added_;
  }
  changed_.notify_all();
}

bool StateKeeper::waitUntilStored() {
  if (!folder_) return false;
  std::unique_lock<std::mutex> lock(mutex_);
  const std::uint64_t target = added_, failures = failures_;
  changed_.wait_for(lock, kDiskPatience, [&] { return stored_ >= target || failures_ > failures || ending_; });
  return stored_ >= target && !behind_;
}

/// The thread that writes to the disk runs this.
void StateKeeper::run() {
  WaitingChanges changes;
  std::uint64_t target = 0;
  bool failed = false;
  bool anew = true;  // write a new file: at the start, and after a failure, which may have written a part of a record
  while (true) {
    {
      std::unique_lock<std::mutex> lock(mutex_);
      if (failed) changed_.wait_for(lock, kDiskRetry, [this] { return ending_; });
      if (!anew) changed_.wait(lock, [this] { return ending_ || !waiting_.empty(); });
      if (ending_ && (failed || (waiting_.empty() && !anew))) return;
      if (changes.empty()) {  // else the last attempt ended before it had applied them
        changes.swap(waiting_);
        target = added_;
      }
    }
    const auto failure = guarded(commons_.ledger, "state.failed", [&] { write(changes, anew); });
    anew = failed = failure.has_value();
    guarded(commons_.ledger, "state.failed", [&] { tell(failed ? failure->what() : ""); });
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      failed ? ++failures_ : stored_ = target;
    }
    changed_.notify_all();
  }
}

/// Applies changes to items_ and writes them. Empties `changes` as soon as items_ contains them.
/// @param anew  whether to write a new file with all items
void StateKeeper::write(WaitingChanges& changes, bool anew) {
  const Edits edits = newEdits(changes);
  applyEdits(edits, items_);
  changes.clear();
  if (anew) {
    folder_->replace(items_);
  } else if (!edits.empty()) {
    folder_->append(edits);
    if (folder_->size() > 2 * folder_->sizeAtFirst() + kRoom) folder_->replace(items_);
  }
  commons_.ledger.count("state.stored");
}

/// Returns the edits that change items_. A change that only renews a lifetime changes nothing.
StateKeeper::Edits StateKeeper::newEdits(const WaitingChanges& changes) const {
  Edits edits;
  bool all_edited = false;  // whether items may differ from those of items_
  changes.forEach([&](StateEdit edit) {
    const auto known = items_.find(edit.key);
    const bool is_known = edit.kind == StateEdit::Kind::set && known != items_.end() && known->second == edit.text;
    if (is_known && !all_edited) return;
    all_edited = all_edited || edit.kind == StateEdit::Kind::erase_kind;
    edits.push_back(std::move(edit));
  });
  return edits;
}

/// Tells /diagnostics whether changes are stored. @param failure  why not; empty: they are
void StateKeeper::tell(const std::string& failure) {
  commons_.health.noteState({commons_.settings.params.state_folder, failure, restored_.obstacles.size(),
                             restored_.rules.size(), restored_.troubles});
}

}  // namespace hgrid
