// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// What a node does at its start if another node already has its name: the state of the other node decides.
#include <ros/master.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcServer.h>
#include <xmlrpcpp/XmlRpcServerMethod.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "test/node/support/built.h"
#include "test/node/support/claims.h"

namespace hgrid {
namespace test {
namespace {

using XmlRpc::XmlRpcValue;

/// Checks the condition again and again, because processes and the master send no message when it becomes true.
::testing::AssertionResult becomesTrue(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return ::testing::AssertionFailure() << "waited 20 s";
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return ::testing::AssertionSuccess();
}

/// Returns where the master says that the node of this name is; empty if no node has the name.
std::string addressOf(const std::string& name) {
  XmlRpcValue request, response, uri;
  request[0] = "/name_test";
  request[1] = name;
  return ros::master::execute("lookupNode", request, response, uri, false) ? static_cast<std::string&>(uri) : "";
}

/// Registers the node of this name as a publisher of a topic below its name, or removes this registration.
void setPublisher(const char* method, const std::string& name, const std::string& uri) {
  XmlRpcValue request, response, payload;
  request[0] = name;
  request[1] = name + "/topic";
  if (std::string(method) == "registerPublisher") request[2] = "std_msgs/Empty";
  request[request.size()] = uri;
  ASSERT_TRUE(ros::master::execute(method, request, response, payload, false));
}

NodeSetup setupOfPost() {
  NodeSetup setup;
  setup.params = dict({{"world_frame", "world"}, {"obstacles", list({ball("post", 0, 0, 0, 0.1)})}});
  return setup;
}

/// A node that is started in a namespace in which a node of its name may already run.
class SecondNode {
 public:
  explicit SecondNode(const std::string& space, const std::string& option = "__log:=/dev/null")
      : name_(space + "/proximity"), output_((std::filesystem::temp_directory_path() / "second_node.log").string()) {
    std::filesystem::remove(output_);
    process_ = std::make_unique<ChildProcess>(
        std::vector<std::string>{built(HGRID_NODE), option, "__ns:=" + space, "__name:=proximity"}, output_,
        std::map<std::string, std::string>{{"ROSCONSOLE_STDOUT_LINE_BUFFERED", "1"}});
  }
  ~SecondNode() {
    process_.reset();
    std::filesystem::remove(output_);
  }

  ChildProcess& process() { return *process_; }
  std::string output() const {
    std::ifstream file(output_);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// Returns how often the node has logged this text.
  int count(const std::string& text) const {
    const std::string all = output();
    int found = 0;
    for (std::size_t at = all.find(text); at != std::string::npos; at = all.find(text, at + 1)) ++found;
    return found;
  }
  /// Succeeds as soon as the node has logged this text.
  ::testing::AssertionResult says(const std::string& text) const {
    return becomesTrue([&] { return count(text) > 0; }) << " for '" << text << "' in:\n" << output();
  }
  /// Succeeds as soon as the node has the name, which was registered at another address.
  ::testing::AssertionResult takesTheNameFrom(const std::string& uri) const {
    return becomesTrue([&] {
             const std::string now = addressOf(name_);
             return !now.empty() && now != uri;
           })
           << " for the registration of " << name_ << "\n"
           << output();
  }

 private:
  const std::string name_, output_;
  std::unique_ptr<ChildProcess> process_;
};

TEST(Name, OfARunningNodeIsNotTaken) {
  NodeUnderTest first(setupOfPost());
  const std::string name = first.space() + "/proximity", uri = addressOf(name);
  SecondNode second(first.space());
  EXPECT_EQ(second.process().waitForEnd(20.0).value_or(-1), 4) << second.output();
  EXPECT_EQ(second.count("The name '" + name + "' belongs to a running node (process " +
                         std::to_string(first.process().pid()) + " at " + uri + "), so this node does not start"),
            1)
      << second.output();
  first.waitForTicks(2);
  EXPECT_TRUE(first.process().alive());
  EXPECT_EQ(addressOf(name), uri);
}

TEST(Name, OfAKilledNodeIsTaken) {
  NodeUnderTest first(setupOfPost());
  const std::string uri = addressOf(first.space() + "/proximity");
  first.process().signal(SIGKILL);
  first.process().waitForEnd(20.0);
  ASSERT_EQ(addressOf(first.space() + "/proximity"), uri) << "the registration must be left behind";
  SecondNode second(first.space());
  EXPECT_TRUE(second.takesTheNameFrom(uri));
  EXPECT_EQ(second.count("no node of this name answers there"), 1) << second.output();
  first.waitForTicks(2);  // of the second node, which has the same topics
}

TEST(Name, OfAHangingNodeIsTaken) {
  NodeUnderTest first(setupOfPost());
  const std::string uri = addressOf(first.space() + "/proximity");
  first.process().signal(SIGSTOP);  // the kernel still accepts connections for the process
  SecondNode second(first.space());
  EXPECT_TRUE(second.takesTheNameFrom(uri));
  EXPECT_EQ(second.count("at " + uri + ", but no node of this name answers there"), 1) << second.output();
  first.process().signal(SIGCONT);
  EXPECT_EQ(first.process().waitForEnd(20.0).value_or(-1), 3);
  first.waitForTicks(2);
  EXPECT_TRUE(second.process().alive());
}

/// Claim: a node that was killed does not keep its name, even if its port now belongs to another node that answers.
TEST(Name, OfAKilledNodeIsTakenIfAnotherNodeHasItsPort) {
  NodeUnderTest other(setupOfPost());
  const std::string uri = addressOf(other.space() + "/proximity"), space = other.space() + "_killed";
  setPublisher("registerPublisher", space + "/proximity", uri);
  SecondNode second(space);
  EXPECT_TRUE(second.takesTheNameFrom(uri));
  EXPECT_EQ(second.count("no node of this name answers there"), 1) << second.output();
  other.waitForTicks(2);
}

/// The XML-RPC server of a node that answers twice that it runs, and then unregisters, as a node that is ending.
class EndingNode {
 public:
  explicit EndingNode(const std::string& name) : name_(name), pid_(*this), publications_(*this) {
    server_.bindAndListen(0);
    uri_ = "http://127.0.0.1:" + std::to_string(server_.get_port()) + "/";
    setPublisher("registerPublisher", name_, uri_);
    thread_ = std::thread([this] {
      while (!stopped_) server_.work(0.01);
    });
  }
  ~EndingNode() {
    stopped_ = true;
    thread_.join();
    server_.shutdown();
  }
  const std::string& uri() const { return uri_; }
  int answers() const { return answers_; }

 private:
  struct Pid : XmlRpc::XmlRpcServerMethod {
    explicit Pid(EndingNode& of) : XmlRpcServerMethod("getPid", &of.server_), node(of) {}
    void execute(XmlRpcValue&, XmlRpcValue& result) override {
      result[0] = 1;
      result[1] = "";
      result[2] = 4711;
      if (++node.answers_ == 2) setPublisher("unregisterPublisher", node.name_, node.uri_);
    }
    EndingNode& node;
  };
  struct Publications : XmlRpc::XmlRpcServerMethod {
    explicit Publications(EndingNode& of) : XmlRpcServerMethod("getPublications", &of.server_), node(of) {}
    void execute(XmlRpcValue&, XmlRpcValue& result) override {
      result[0] = 1;
      result[1] = "";
      result[2][0][0] = node.name_ + "/topic";
      result[2][0][1] = "std_msgs/Empty";
    }
    EndingNode& node;
  };

  const std::string name_;
  std::string uri_;
  XmlRpc::XmlRpcServer server_;
  Pid pid_;
  Publications publications_;
  std::atomic<int> answers_{0};
  std::atomic<bool> stopped_{false};
  std::thread thread_;
};

/// Claim: a node may be started at once after a node of its name was asked to end, although that one still answers.
TEST(Name, OfANodeThatEndsAtOnceIsTaken) {
  const std::string space = "/ending_" + std::to_string(getpid());
  EndingNode first(space + "/proximity");
  SecondNode second(space);
  EXPECT_TRUE(second.takesTheNameFrom(first.uri()));
  EXPECT_GE(first.answers(), 2);
  EXPECT_TRUE(second.process().alive());
}

TEST(Name, IsTakenByAWaitingNodeWhenTheOtherNodeEnds) {
  NodeUnderTest first(setupOfPost());
  const std::string uri = addressOf(first.space() + "/proximity");
  SecondNode second(first.space(), "--wait");
  ASSERT_TRUE(second.says("This node waits until that node has ended"));
  first.waitForTicks(2);
  first.process().signal(SIGTERM);
  EXPECT_EQ(first.process().waitForEnd(20.0).value_or(-1), 0);
  EXPECT_TRUE(second.takesTheNameFrom(uri));
  first.waitForTicks(2);  // of the second node
  EXPECT_EQ(second.count("This node waits"), 1) << second.output();
}

TEST(Name, DoesNotKeepAWaitingNodeFromEnding) {
  NodeUnderTest first(setupOfPost());
  SecondNode second(first.space(), "--wait");
  ASSERT_TRUE(second.says("This node waits until that node has ended"));
  second.process().signal(SIGTERM);
  EXPECT_EQ(second.process().waitForEnd(20.0).value_or(-1), 0);
  EXPECT_EQ(second.count("took longer"), 0) << second.output();
  first.waitForTicks(2);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
