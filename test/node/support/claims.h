// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <gtest/gtest.h>
#include <sys/types.h>

#include <cmath>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "test/node/support/built.h"
#include "test/node/support/node_under_test.h"
#include "test/node/support/readings.h"
#include "test/support/refusals.h"

namespace hgrid {
namespace test {

/// Succeeds if one of the sentences contains `words`.
inline ::testing::AssertionResult oneSays(const std::vector<std::string>& sentences, const std::string& words) {
  for (const std::string& sentence : sentences) {
    if (says(sentence, words)) return ::testing::AssertionSuccess();
  }
  return ::testing::AssertionFailure() << "none of " << sentences.size() << " sentences contains '" << words << "'";
}

/// Succeeds if the node logged lines with the text `cause`, but on average at most one per second.
inline ::testing::AssertionResult throttled(const NodeUnderTest& node, const std::string& cause) {
  const std::size_t lines = node.lines(cause);
  const double seconds = node.uptime();
  if (lines >= 1 && static_cast<double>(lines) <= 1.0 + seconds) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << lines << " lines with '" << cause << "' in " << seconds << " s";
}

/// Returns the names of the bodies that a query hit, in the order of the answer.
inline std::vector<std::string> namesOf(const msg::Answer& answer) {
  std::vector<std::string> names;
  for (const msg::Hit& hit : answer.hits) names.push_back(hit.name);
  return names;
}

/// Returns the resident and the virtual memory [kB] of a process.
inline std::pair<std::size_t, std::size_t> memoryOf(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/statm");
  std::size_t pages = 0, resident = 0;
  file >> pages >> resident;
  return {resident * 4, pages * 4};
}

/// Returns whether a process reserved virtual memory for a message of test/node/support/silent_publisher.py.
/// `before`: its memory (memoryOf) before that.
inline bool hasReserved(pid_t process, const std::pair<std::size_t, std::size_t>& before) {
  return memoryOf(process).second > before.second + 900000;
}

/// Claim: a message that is announced and never sent is not in the memory of a process.
inline ::testing::AssertionResult costsOnlyAddressSpace(pid_t process,
                                                        const std::pair<std::size_t, std::size_t>& before) {
  const std::size_t now = memoryOf(process).first;
  if (now < before.first + mostGrowth(4000)) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "resident: " << before.first << " kB before, " << now << " kB after";
}

inline std::size_t residentKilobytes(pid_t process) { return memoryOf(process).first; }
inline std::size_t virtualKilobytes(pid_t process) { return memoryOf(process).second; }

/// Returns the largest resident memory [kB] of a process since it was started.
inline std::size_t peakKilobytes(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/status");
  std::string word;
  while (file >> word && word != "VmHWM:") continue;
  std::size_t kilobytes = 0;
  file >> kilobytes;
  return kilobytes;
}

/// Returns the x coordinate [m] of the center of the spherical body `body` with radius `radius`. Measures it with a
/// segment query along x through (y, z). Returns NaN if the segment does not hit exactly one body.
inline double xOf(NodeUnderTest& node, const std::string& body, double radius = 0.1, double y = 0.0, double z = 0.0) {
  msg::QuerySegment::Request request;
  request.start.x = -50.0;
  request.end.x = 50.0;
  request.start.y = request.end.y = y;
  request.start.z = request.end.z = z;
  request.include = {body};
  const auto answer = node.ask(request).answer;
  return answer.hits.size() == 1 ? answer.hits.front().along - 50.0 + radius : std::nan("");
}

}  // namespace test
}  // namespace hgrid
