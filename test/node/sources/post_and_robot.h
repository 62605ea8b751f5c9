// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <gtest/gtest.h>
#include <hgrid_proximity/Verdict.h>

#include <string>
#include <vector>

#include "test/node/support/claims.h"
#include "test/node/support/node_under_test.h"

namespace hgrid {
namespace test {

/// Returns the setup of a node with the obstacle "post". A test can add the description of a robot to its `beside`.
inline NodeSetup besidePost() {
  NodeSetup setup;
  setup.params = dict({{"world_frame", "base"}, {"obstacles", list({ball("post", 2, 0, 0, 0.1)})}});
  return setup;
}

/// Waits until the diagnostic `name` has this level and a message that contains `words`.
inline void waitForDiagnostic(NodeUnderTest& node, const std::string& name, int level, const std::string& words) {
  node.waitUntil(name + " says " + words, [&](const Heard& all) {
    const auto found = all.diagnostics.find(name);
    return found != all.diagnostics.end() && found->second.level == level &&
           found->second.message.find(words) != std::string::npos;
  });
}

/// Waits until the log has exactly one line with this text. The line may come after the first tick with the robot.
inline void waitForLine(NodeUnderTest& node, const std::string& text) {
  node.waitUntil("the log says " + text, [&](const Heard&) { return node.lines(text) == 1; });
}

/// Expects that queries find the post, and that nothing else is known, because the robot is missing.
inline void expectOnlyThePostServes(NodeUnderTest& node) {
  EXPECT_EQ(namesOf(node.sphere(2, 0, 0, 0.05).answer), std::vector<std::string>({"obstacle/post"}));
  EXPECT_EQ(node.sphere(0, 0, 0, 0.05).answer.verdict, msg::Verdict::UNKNOWN) << "the robot may be there";
}

}  // namespace test
}  // namespace hgrid
