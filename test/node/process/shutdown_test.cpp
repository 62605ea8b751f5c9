// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// SIGINT, SIGTERM and SIGHUP end the node in the same way: it unregisters from the master, and its exit code is 0.
#include <ros/master.h>
#include <ros/network.h>
#include <ros/service.h>
#include <xmlrpcpp/XmlRpcClient.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "test/node/support/built.h"
#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/own_master.h"
#include "test/node/support/registrations.h"

namespace hgrid {
namespace test {
namespace {

namespace fs = std::filesystem;

constexpr int kEndSignals[] = {SIGINT, SIGTERM, SIGHUP};

XmlRpc::XmlRpcValue stateOfMaster() {
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = "/shutdown_test";
  if (!ros::master::execute("getSystemState", request, response, state, false)) throw std::runtime_error("no master");
  return state;
}

/// Succeeds if a node ends with exit code 0 and has removed all its registrations at the master.
::testing::AssertionResult endsAndUnregisters(NodeUnderTest& node) {
  const std::optional<int> code = node.process().waitForEnd(20.0);
  if (!code) return ::testing::AssertionFailure() << "the node still runs";
  if (*code != 0) return ::testing::AssertionFailure() << "exit code " << *code << "\n" << node.output();
  const std::vector<std::string> left = registrationsOf(node.space() + "/proximity", stateOfMaster());
  if (left.empty()) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << left.size() << " registrations are left; the first: it " << left.front();
}

NodeSetup setupOfWorld() {
  NodeSetup setup;
  setup.params = dict({{"world_frame", "world"}, {"obstacles", list({ball("post", 0, 0, 0, 0.1)})}});
  setup.beside["robot_description"] = urdf(link("world", sphereOf(0.1, "0 0 -5")));
  return setup;
}

TEST(Shutdown, OfAnIdleNodeUnregisters) {
  for (const int number : kEndSignals) {
    NodeUnderTest node(setupOfWorld());
    ASSERT_FALSE(registrationsOf(node.space() + "/proximity", stateOfMaster()).empty());
    node.process().signal(number);
    EXPECT_TRUE(endsAndUnregisters(node)) << "signal " << number;
  }
}

TEST(Shutdown, DuringQueriesUnregisters) {
  for (const int number : kEndSignals) {
    NodeUnderTest node(setupOfWorld());
    node.waitForComplete();
    std::atomic<std::uint64_t> answers{0};
    std::thread client([&] {
      try {
        for (;; ++answers) node.sphere(0, 0, 0, 0.1);
      } catch (const std::runtime_error&) {  // the node has ended
      }
    });
    node.waitForTicks(5);
    node.process().signal(number);
    EXPECT_TRUE(endsAndUnregisters(node)) << "signal " << number;
    client.join();
    EXPECT_GT(answers, 0u);
  }
}

/// A folder with a copy of the node's library and a mesh reader that never ends. The node uses this mesh reader,
/// because it searches for the mesh reader relative to its library.
class HangingReader {
 public:
  HangingReader() {
    std::string folder = (fs::temp_directory_path() / "hanging_reader_XXXXXX").string();
    if (mkdtemp(&folder[0]) == nullptr) throw std::runtime_error("no scratch folder");
    folder_ = folder;
    fs::create_directories(folder_ / "hgrid_proximity");
    fs::copy_file(built(HGRID_NODE_LIBRARY), library());
    const fs::path reader = folder_ / "hgrid_proximity" / "proximity_mesh_reader";
    std::ofstream(reader) << "#!/bin/sh\n: >'" << started().string() << "'\nexec sleep 3600\n";
    fs::permissions(reader, fs::perms::owner_all);
    std::ofstream(folder_ / "part.stl") << "solid part\nendsolid part\n";
  }
  ~HangingReader() { fs::remove_all(folder_); }

  /// Returns the setup of a node that uses this mesh reader and may read the mesh of description().
  NodeSetup setup() const {
    NodeSetup setup = setupOfWorld();
    setup.params["mesh_roots"] = list({folder_.string()});
    setup.params["limits"]["mesh_timeout"] = 600.0;
    setup.environment["LD_PRELOAD"] = library().string();
    return setup;
  }
  /// Returns a URDF with one mesh.
  std::string description() const {
    return urdf(link("world", collision("<mesh filename=\"file://" + (folder_ / "part.stl").string() + "\"/>")));
  }
  /// Waits until the node has started the mesh reader. Polls, because the mesh reader cannot send messages.
  void waitForStart() const {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!fs::exists(started()) && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ASSERT_TRUE(fs::exists(started())) << "the node has not started the mesh reader";
  }

 private:
  fs::path library() const { return folder_ / fs::path(HGRID_NODE_LIBRARY).filename(); }
  fs::path started() const { return folder_ / "started"; }

  fs::path folder_;
};

TEST(Shutdown, DuringTheFirstLoadOfASlowMeshUnregisters) {
  const HangingReader reader;
  NodeSetup setup = reader.setup();
  setup.beside["robot_description"] = reader.description();
  NodeUnderTest node(setup, false);
  reader.waitForStart();
  node.process().signal(SIGTERM);
  EXPECT_TRUE(endsAndUnregisters(node));
}

TEST(Shutdown, DuringAReloadOfASlowMeshUnregisters) {
  const HangingReader reader;
  NodeUnderTest node(reader.setup());
  node.waitForComplete();
  node.setBeside("robot_description", reader.description());
  std::thread client([&] {
    try {
      node.reload("");
    } catch (const std::runtime_error&) {  // the node has ended
    }
  });
  reader.waitForStart();
  node.process().signal(SIGTERM);
  EXPECT_TRUE(endsAndUnregisters(node));
  client.join();
}

/// A node that uses its own ROS master.
class NodeOfMaster {
 public:
  static constexpr const char* kName = "/proximity";
  /// @param before  program and arguments that start the node, such as `nohup`
  explicit NodeOfMaster(const std::string& uri, std::vector<std::string> before = {}) {
    fs::remove(output_);
    before.insert(before.end(), {built(HGRID_NODE), "_world_frame:=world"});
    process_ = std::make_unique<ChildProcess>(
        before, output_,
        std::map<std::string, std::string>{{"ROS_MASTER_URI", uri}, {"ROSCONSOLE_STDOUT_LINE_BUFFERED", "1"}});
  }
  ~NodeOfMaster() {
    process_.reset();
    fs::remove(output_);
  }
  ChildProcess& process() { return *process_; }
  std::string output() const {
    std::ifstream file(output_);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Succeeds if the node ends with exit code 0.
  ::testing::AssertionResult ends() {
    const std::optional<int> code = process_->waitForEnd(20.0);
    if (code == 0) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << (code ? "exit code " + std::to_string(*code) : "the node still runs")
                                         << "\n"
                                         << output();
  }

 private:
  const std::string output_ = (fs::temp_directory_path() / "node_of_master.log").string();
  std::unique_ptr<ChildProcess> process_;
};

TEST(Shutdown, NeedsNoMaster) {
  OwnMaster master;
  NodeOfMaster node(master.uri());
  master.waitForRegistration(node.kName, "serves /proximity/reload_robot");
  master.process().signal(SIGKILL);
  master.process().waitForEnd(20.0);
  node.process().signal(SIGTERM);
  EXPECT_TRUE(node.ends());
}

TEST(Shutdown, NeedsNoAnswerOfTheMaster) {
  OwnMaster master;
  NodeOfMaster node(master.uri());
  master.waitForRegistration(node.kName, "serves /proximity/reload_robot");
  master.process().signal(SIGSTOP);
  node.process().signal(SIGTERM);
  EXPECT_TRUE(node.ends());
  master.process().signal(SIGCONT);
}

TEST(Shutdown, EndsANodeThatWaitsForTheMaster) {
  for (const int number : kEndSignals) {
    NodeOfMaster node("http://127.0.0.1:" + std::to_string(freePort()));
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!says(node.output(), "Failed to contact master") && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));  // polls, because the output is a file
    }
    ASSERT_TRUE(says(node.output(), "Failed to contact master"));
    node.process().signal(number);
    EXPECT_TRUE(node.ends()) << "signal " << number;
  }
}

/// Returns whether a process ignores a signal.
bool ignores(pid_t process, int number) {
  std::ifstream file("/proc/" + std::to_string(process) + "/status");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("SigIgn:", 0) == 0) return (std::stoull(line.substr(7), nullptr, 16) >> (number - 1) & 1) != 0;
  }
  throw std::runtime_error("no process " + std::to_string(process));
}

TEST(Shutdown, KeepsIgnoringHangupsUnderNohup) {
  OwnMaster master;
  NodeOfMaster node(master.uri(), {"nohup"});
  master.waitForRegistration(node.kName, "serves /proximity/reload_robot");
  EXPECT_TRUE(ignores(node.process().pid(), SIGHUP));
  EXPECT_FALSE(ignores(node.process().pid(), SIGTERM));
  node.process().signal(SIGTERM);
  EXPECT_TRUE(node.ends());
}

TEST(Shutdown, IsLoggedAndHasExitCode3IfAnotherNodeTakesTheName) {
  NodeUnderTest first(setupOfWorld());
  const std::string name = first.space() + "/proximity";
  first.waitForTicks(1);  // if the first node still registered topics, the master would end the second node
  ChildProcess second({built(HGRID_NODE), "--replace", "__ns:=" + first.space(), "__name:=proximity"}, "/dev/null", {});
  EXPECT_EQ(first.process().waitForEnd(20.0).value_or(-1), 3);
  EXPECT_EQ(first.lines("Another node has registered under the name '" + name + "'"), 1u) << first.output();
  EXPECT_TRUE(second.alive());
}

TEST(Shutdown, ByRosnodeKillUnregisters) {
  NodeUnderTest node(setupOfWorld());
  ChildProcess killer({"rosnode", "kill", node.space() + "/proximity"}, "/dev/null", {});
  EXPECT_TRUE(endsAndUnregisters(node));
}

/// Returns the XML-RPC URI of a node.
std::string uriOf(const NodeUnderTest& node) {
  XmlRpc::XmlRpcValue request, response, uri;
  request[0] = "/shutdown_test";
  request[1] = node.space() + "/proximity";
  if (!ros::master::execute("lookupNode", request, response, uri, false)) throw std::runtime_error("no such node");
  return uri;
}

/// Sends an XML-RPC request `shutdown` to a node. @param words  name of the caller and, if given, the reason
bool sendShutdown(const NodeUnderTest& node, const std::vector<std::string>& words) {
  XmlRpc::XmlRpcValue request, result;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uriOf(node), host, port)) return false;
  for (std::size_t i = 0; i < words.size(); ++i) request[static_cast<int>(i)] = words[i];
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  return client.execute("shutdown", request, result);
}

/// Claim: a node that has its name does not end because a master says that a new node has it. The master may mean an
/// earlier node that used the same port, of this name at another master, or of another name.
TEST(Shutdown, IsIgnoredIfItIsMeantForAnEarlierNode) {
  NodeUnderTest node(setupOfWorld());
  for (const std::string& name : {node.space() + "/proximity", std::string("/earlier")}) {
    ASSERT_TRUE(sendShutdown(node, {"/master", "[" + name + "] Reason: new node registered with same name"}));
  }
  node.waitForTicks(2);
  EXPECT_TRUE(node.process().alive());
  EXPECT_EQ(node.lines("The request is probably meant for an earlier node"), 2u) << node.output();
  node.process().signal(SIGTERM);
  EXPECT_TRUE(endsAndUnregisters(node));  // with exit code 0, so it was not ending before
}

/// Claim: a node also ends if it got its name back, because the master has then removed what it had registered before.
TEST(Shutdown, IsNotIgnoredIfTheNameWasTakenForAMoment) {
  NodeUnderTest node(setupOfWorld());
  const std::string uri = uriOf(node);
  for (const std::string& by : {std::string("http://127.0.0.1:9/"), uri}) {
    XmlRpc::XmlRpcValue request, response, payload;
    request[0] = node.space() + "/proximity";
    request[1] = node.space() + "/topic";
    request[2] = "std_msgs/Empty";
    request[3] = by;
    ASSERT_TRUE(ros::master::execute("registerPublisher", request, response, payload, false));
  }
  EXPECT_EQ(node.process().waitForEnd(20.0).value_or(-1), 3) << node.output();
}

/// Claim: the reason of an XML-RPC request `shutdown` is optional, as the interface of ROS nodes says.
TEST(Shutdown, NeedsNoReason) {
  NodeUnderTest node(setupOfWorld());
  ASSERT_TRUE(sendShutdown(node, {"/shutdown_test"}));
  EXPECT_TRUE(endsAndUnregisters(node));
  EXPECT_EQ(node.lines("gives no reason"), 1u) << node.output();
}

}  // namespace
}  // namespace test
}  // namespace hgrid
