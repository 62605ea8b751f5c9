// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/diagnostics/node_diagnostics.h"

#include "node/messages/to_messages.h"
#include "node/messages/world_state_message.h"

namespace hgrid {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

constexpr std::uint64_t kLongestWait = 10;  // [ticks] a pair should be measured again within this many ticks
constexpr std::size_t kMostLines = 20;      // largest number of entries of a list; ~status has longer lists

void addAll(DiagnosticStatusWrapper& status, const std::string& key, const std::vector<std::string>& all) {
  const std::vector<std::string> lines = shortened(all, kMostLines);
  for (std::size_t i = 0; i < lines.size(); ++i) status.add(key + " " + std::to_string(i + 1), lines[i]);
}

/// Adds the counts of self pairs of all robots, and a warning for each robot whose counts look wrong.
void addSelfPairs(DiagnosticStatusWrapper& status, const ModelReport& report) {
  for (const auto& [robot, counts] : report.self_pairs) {
    status.add("self pairs of " + robot, text(counts));
    if (counts.looksWrong()) status.mergeSummary(DiagnosticStatus::WARN, robot + ": " + text(counts));
  }
}

}  // namespace

NodeDiagnostics::NodeDiagnostics(ros::NodeHandle node, ros::NodeHandle private_node, const std::string& name,
                                 NewestTick newest, const NodeHealth& health)
    : newest_(std::move(newest)), health_(health), updater_(node, private_node, name) {
  updater_.setHardwareID("none");
  updater_.add("world", this, &NodeDiagnostics::world);
  updater_.add("robots", this, &NodeDiagnostics::robots);
  updater_.add("transforms", this, &NodeDiagnostics::transforms);
  updater_.add("ticks", this, &NodeDiagnostics::ticks);
  updater_.add("audit", this, &NodeDiagnostics::audit);
  updater_.add("state", this, &NodeDiagnostics::state);
}

void NodeDiagnostics::world(DiagnosticStatusWrapper& status) {
  const auto tick = newest_();
  if (!tick || !tick->snapshot) {
    status.summary(DiagnosticStatus::ERROR, "there is no world yet");
    if (tick) addAll(status, "reason", tick->not_ready);
    return;
  }
  const Snapshot& snapshot = *tick->snapshot;
  if (!snapshot.complete()) {
    status.summary(DiagnosticStatus::ERROR, "the world is not complete: " + snapshot.reasons().front());
  } else if (snapshot.worstState() >= Freshness::stale) {
    status.summary(DiagnosticStatus::WARN, std::string("some bodies are ") + name(snapshot.worstState()));
  } else {
    status.summary(DiagnosticStatus::OK, "complete");
  }
  if (snapshot.truncated()) status.mergeSummary(DiagnosticStatus::ERROR, truncationOf(snapshot));
  const bool silenced = snapshot.structure().silenced;
  if (silenced) status.mergeSummary(DiagnosticStatus::WARN, "rules switch off every pair, so no pair is reported");
  status.add("bodies", snapshot.poses().size());
  status.add("near pairs", snapshot.pairs().size());
  status.add("age of the oldest pose [s]", snapshot.maxAge());
  status.add("rules of the allowed-pair matrix", snapshot.structure().filter.rules().size());
  status.add("rules switch off every pair", silenced ? "yes" : "no");
  addAll(status, "source that is not complete", snapshot.incompleteSources());
  addAll(status, "reason", snapshot.reasons());
}

void NodeDiagnostics::robots(DiagnosticStatusWrapper& status) {
  const auto tick = newest_();
  const HealthReport health = health_.report();
  const ModelReport report = tick ? *tick->models : ModelReport{};
  if (!health.failed_loads.empty()) {
    status.summary(DiagnosticStatus::ERROR, health.failed_loads.begin()->second);
  } else if (!report.uncovered.empty()) {
    status.summary(DiagnosticStatus::ERROR, "UNCOVERED " + report.uncovered.front());
  } else if (!report.warnings.empty()) {
    status.summary(DiagnosticStatus::WARN, report.warnings.front());
  } else {
    status.summary(DiagnosticStatus::OK, report.waived.empty() ? "all shapes were read"
                                                               : "all shapes were read, except those that are waived");
  }
  addSelfPairs(status, report);
  status.add("robots loaded", report.robots);
  for (const auto& failure : health.failed_loads) status.add("not read: " + failure.first, failure.second);
  addAll(status, "uncovered", report.uncovered);
  addAll(status, "waived", report.waived);
  addAll(status, "without collision", report.without_collision);
  addAll(status, "uses visual geometry", report.uses_visual);
  addAll(status, "warning", report.warnings);
}

void NodeDiagnostics::transforms(DiagnosticStatusWrapper& status) {
  const auto tick = newest_();
  const HealthReport health = health_.report();
  status.summary(DiagnosticStatus::OK, "all frames are known and fresh");
  if (!health.conflicts.empty()) {
    status.summary(DiagnosticStatus::WARN,
                   "frame '" + health.conflicts.front() + "' is published on both /tf and /tf_static");
  }
  if (!tick) return;
  for (const std::string& fight : tick->contested_frames) status.mergeSummary(DiagnosticStatus::WARN, fight);
  for (const BodyTrouble& trouble : tick->troubles) {
    if (trouble.code == Code::conflict && !tick->contested_frames.empty()) continue;  // reported above
    const bool grave = trouble.state >= Freshness::lost;
    status.mergeSummary(grave ? DiagnosticStatus::ERROR : DiagnosticStatus::WARN, trouble.sentence);
    break;  // only the worst is shown; ~status lists the others
  }
  addAll(status, "missing frame", tick->missing_frames);
  addAll(status, "conflict", health.conflicts);
  addAll(status, "contested frame", tick->contested_frames);
  status.add("bodies not fresh", tick->troubles.size());
}

void NodeDiagnostics::ticks(DiagnosticStatusWrapper& status) {
  const HealthReport health = health_.report();
  const auto tick = newest_();
  if (health.failed_tick) {
    status.summary(DiagnosticStatus::ERROR, std::string("the last tick failed: ") + name(health.failed_tick->code()) +
                                                " " + health.failed_tick->what());
  } else if (health.late_ticks_in_a_row >= 3) {
    status.summary(DiagnosticStatus::ERROR, std::to_string(health.late_ticks_in_a_row) + " ticks in a row were late");
  } else if (health.late_ticks_in_a_row > 0) {
    status.summary(DiagnosticStatus::WARN, "the last tick was late");
  } else {
    status.summary(DiagnosticStatus::OK, "on time");
  }
  if (health.failed_distances) {
    status.mergeSummary(DiagnosticStatus::ERROR, std::string("the last measurement of ~distances failed: ") +
                                                     name(health.failed_distances->code()) + " " +
                                                     health.failed_distances->what());
  }
  if (health.failed_structure) {
    status.mergeSummary(DiagnosticStatus::ERROR, std::string("~bodies and ~rules could not be published: ") +
                                                     name(health.failed_structure->code()) + " " +
                                                     health.failed_structure->what());
  }
  if (health.longest_wait > kLongestWait) {
    status.mergeSummary(DiagnosticStatus::WARN,
                        "the distance of a pair was not measured for " + std::to_string(health.longest_wait) +
                            " ticks; it should be at most " + std::to_string(kLongestWait) +
                            "; increase ~distances/budget or ~distances/threads, or reduce ~distances/max");
  }
  for (const auto& missing : health.missing_threads) status.mergeSummary(DiagnosticStatus::WARN, missing.second);
  status.add("failed ticks", health.failed_ticks);
  status.add("longest time without a measurement of a pair [ticks]", health.longest_wait);
  if (tick && tick->snapshot) status.add("sequence", tick->snapshot->sequence());
}

void NodeDiagnostics::audit(DiagnosticStatusWrapper& status) {
  const HealthReport health = health_.report();
  if (health.different_audits > 0) {
    status.summary(DiagnosticStatus::ERROR, health.audit_difference);
  } else if (health.audits > 0) {
    status.summary(DiagnosticStatus::OK, "no difference");
  } else {
    status.summary(DiagnosticStatus::OK, "no tick was audited yet; see ~audit_rate");
  }
  status.add("audited ticks", health.audits);
  status.add("audits with a difference", health.different_audits);
}

void NodeDiagnostics::state(DiagnosticStatusWrapper& status) {
  const StateReport state = health_.report().state;
  if (!state.failure.empty()) {
    status.summary(DiagnosticStatus::ERROR, "changes are not stored: " + state.failure);
  } else if (!state.unreadable.empty()) {
    status.summary(DiagnosticStatus::ERROR, "not restored: " + state.unreadable.front());
  } else {
    status.summary(DiagnosticStatus::OK, state.folder.empty() ? "changes are not stored; see ~state_folder"
                                                              : "changes are stored in " + state.folder);
  }
  status.add("restored obstacles", state.obstacles);
  status.add("restored rules", state.rules);
  addAll(status, "not restored", state.unreadable);
}

}  // namespace hgrid
