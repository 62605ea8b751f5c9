// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The audit of a running node.
#include <gtest/gtest.h>

#include <filesystem>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

namespace fs = std::filesystem;
using diagnostic_msgs::DiagnosticStatus;

/// A folder that is removed at the end.
struct Folder {
  Folder() {
    char name[] = "/tmp/hgrid_audit_XXXXXX";
    if (mkdtemp(name) == nullptr) throw std::runtime_error("no temporary folder could be made");
    path = name;
  }
  ~Folder() { fs::remove_all(path); }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path)) names.push_back(entry.path());
    return names;
  }
  fs::path path;
};

/// Returns the setup of a node with a robot of three links. A fixed joint connects the third link to the second link,
/// 0.3 m away from its origin.
NodeSetup robotWithATool(const Folder& folder) {
  NodeSetup setup;
  const std::string origin = "<origin xyz=\"0.3 0 0\"/>";
  setup.beside["robot_description"] =
      Value(urdf(link("base", sphereOf(0.1)) + link("arm", sphereOf(0.1)) + link("tool", sphereOf(0.1)) +
                 joint("base", "arm") + joint("arm", "tool", "fixed", origin)));
  setup.params = dict({{"audit_rate", 10.0},
                       {"audit_folder", folder.path.string()},
                       {"obstacles", list({ball("post", 0.4, 0, 0, 0.1)})}});
  return setup;
}

void waitForAudits(NodeUnderTest& node, std::uint64_t count) {
  node.waitForStatus("ticks are audited", [&](const msg::Status& s) { return counter(s, "audit.checked") >= count; });
}

void waitForDiagnostic(NodeUnderTest& node, int level, const std::string& words) {
  node.waitUntil("the status audit says " + words, [&](const Heard& all) {
    const auto found = all.diagnostics.find("audit");
    return found != all.diagnostics.end() && found->second.level == level &&
           found->second.message.find(words) != std::string::npos;
  });
}

int exitCodeOf(const std::vector<std::string>& command, const Folder& folder) {
  ChildProcess process(command, (folder.path / "output").string(), {});
  return process.waitForEnd(20.0).value_or(-1);
}

TEST(AuditedNode, IsCleanWhileItMoves) {
  const Folder folder;
  TransformSource transforms;
  transforms.fix({stamped("arm", "tool", at(0.3))});
  transforms.stream("base", "arm", at(0.2, 0.1, 0.0, 0.5));
  NodeUnderTest node(robotWithATool(folder));
  node.waitForComplete();
  waitForAudits(node, 20);
  const auto status = node.heard().status.back();
  EXPECT_EQ(counter(*status, "audit.different"), 0u) << node.output();
  EXPECT_GT(counter(*status, "audit.poses"), counter(*status, "audit.poses_skipped"));
  EXPECT_GT(counter(*status, "audit.queries"), 0u);
  waitForDiagnostic(node, DiagnosticStatus::OK, "no difference");
  EXPECT_TRUE(folder.files().empty());
}

TEST(AuditedNode, ReportsADifferenceAndWritesAFileThatShowsItAgain) {
  const Folder folder;
  TransformSource transforms;
  transforms.fix({stamped("arm", "tool", at(0.31))});  // the node uses 0.3 m, from the description
  transforms.stream("base", "arm", at(0.2, 0.1, 0.0, 0.5));
  NodeUnderTest node(robotWithATool(folder));
  const std::string difference = "'robot/tool' is 0.01 m away from where the transforms";
  waitForDiagnostic(node, DiagnosticStatus::ERROR, difference);
  EXPECT_GE(node.lines(difference), 1u) << "the log has no error";
  node.waitForStatus("it is counted", [](const msg::Status& s) { return counter(s, "audit.different") >= 11; });
  const std::vector<std::string> files = folder.files();
  ASSERT_EQ(files.size(), 10u) << "the number of files is not bounded";
  EXPECT_EQ(exitCodeOf({HGRID_CHECK_AUDIT, files.front()}, folder), 1);
  std::ifstream output(folder.path / "output");
  const std::string text((std::istreambuf_iterator<char>(output)), {});
  EXPECT_TRUE(says(text, difference));
}

TEST(AuditedNode, DoesNotAuditIfTheRateIsZero) {
  const Folder folder;
  TransformSource transforms;
  transforms.stream("base", "arm", at(0.2));
  NodeSetup setup = robotWithATool(folder);
  setup.params["audit_rate"] = 0.0;
  NodeUnderTest node(setup);
  node.waitForComplete();
  node.waitForTicks(50);
  EXPECT_EQ(counter(*node.heard().status.back(), "audit.checked"), 0u);
  waitForDiagnostic(node, DiagnosticStatus::OK, "no tick was audited yet");
}

TEST(CheckAudit, RefusesAFileThatIsNone) {
  const Folder folder;
  EXPECT_EQ(exitCodeOf({HGRID_CHECK_AUDIT}, folder), 2);
  EXPECT_EQ(exitCodeOf({HGRID_CHECK_AUDIT, "/nowhere"}, folder), 2);
  EXPECT_EQ(exitCodeOf({HGRID_CHECK_AUDIT, "/etc/passwd"}, folder), 2);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
