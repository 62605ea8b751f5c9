// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Claim: however many clients call ~query_sphere, and whether a request is answered in the receiving thread or in
// another one, each request gets the right answer, in order, and the node receives transforms all the time.
#include <arpa/inet.h>
#include <hgrid_proximity/Verdict.h>
#include <netdb.h>
#include <ros/network.h>
#include <ros/ros.h>
#include <ros/service_manager.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <functional>
#include <thread>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/raw_message.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using Request = msg::QuerySphere::Request;

/// Returns the i-th request. Even ones hit obstacle/post_2, odd ones hit nothing. Each third one cannot be answered in
/// the receiving thread, because it names bodies.
Request requestOf(std::size_t i) {
  Request request;
  request.center.x = i % 2 == 0 ? 2.0 : 8.0;
  request.radius = 0.5;
  if (i % 3 == 0) request.include = {"obstacle/post_*"};
  return request;
}
bool isAnswer(std::size_t i, const msg::QuerySphere::Response& response) {
  const bool hit = i % 2 == 0;
  return response.answer.verdict == (hit ? msg::Verdict::HIT : msg::Verdict::CLEAR) &&
         response.answer.hits.size() == (hit ? 1u : 0u);
}

/// A connection to a service on which requests can be sent without waiting for the answers.
class OpenConnection {
 public:
  explicit OpenConnection(const std::string& service) {
    std::string host;
    std::uint32_t port = 0;
    if (!ros::ServiceManager::instance()->lookupService(service, host, port)) throw std::runtime_error("no " + service);
    addrinfo hints{}, *found = nullptr;
    hints.ai_family = AF_INET;
    hints.ai_socktype = SOCK_STREAM;
    if (getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) throw std::runtime_error(host);
    socket_ = ::socket(AF_INET, SOCK_STREAM, 0);
    const int failed = ::connect(socket_, found->ai_addr, found->ai_addrlen);
    freeaddrinfo(found);
    const timeval patience{20, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    std::string fields;
    for (const std::string& field :
         {"service=" + service, "md5sum=" + std::string(ros::service_traits::md5sum<msg::QuerySphere>()),
          std::string("callerid=/open_connection"), std::string("persistent=1")}) {
      fields += stringOf(field);
    }
    if (failed != 0 || !send(stringOf(fields))) throw std::runtime_error("cannot connect to " + service);
    receive(lengthAhead());  // the header of the service
  }
  ~OpenConnection() { ::close(socket_); }
  OpenConnection(const OpenConnection&) = delete;
  OpenConnection& operator=(const OpenConnection&) = delete;

  bool send(const Request& request) { return send(stringOf(serialized(request))); }
  /// Waits for the next answer. @throws std::runtime_error if none comes
  msg::QuerySphere::Response receive() {
    if (receive(1) != std::string(1, '\1')) throw std::runtime_error("a call failed");
    std::string bytes = receive(lengthAhead());
    msg::QuerySphere::Response response;
    ros::serialization::IStream stream(reinterpret_cast<std::uint8_t*>(&bytes[0]),
                                       static_cast<std::uint32_t>(bytes.size()));
    ros::serialization::deserialize(stream, response);
    return response;
  }

 private:
  bool send(const std::string& bytes) {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t now = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (now <= 0) return false;
      sent += static_cast<std::size_t>(now);
    }
    return true;
  }
  /// Does not sleep while it waits, so that the next request can be sent as soon as possible.
  std::string receive(std::size_t count) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    std::string bytes(count, '\0');
    for (std::size_t received = 0; received < count;) {
      const ssize_t now = ::recv(socket_, &bytes[received], count - received, MSG_DONTWAIT);
      const bool waits = now < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
      if ((now <= 0 && !waits) || std::chrono::steady_clock::now() > end) {
        throw std::runtime_error("an answer did not come");
      }
      if (now > 0) received += static_cast<std::size_t>(now);
    }
    return bytes;
  }
  std::size_t lengthAhead() {
    const std::string bytes = receive(4);
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data(), sizeof length);
    return length;
  }

  int socket_ = -1;
};

/// Returns 67 obstacles: one at x = 2 m, one at x = 5 m, 64 at x = -10 m, and one that is 1 m beside these 64.
Value obstacles() {
  Value all = list({ball("post_2", 2, 0, 0, 0.1), ball("post_5", 5, 0, 0, 0.1), ball("alone", -10, 1, 0, 0.1)});
  for (int i = 0; i < 64; ++i) all[all.size()] = ball("heap_" + std::to_string(i), -10, 0, 0, 0.1);
  return all;
}

/// A node with these obstacles. The clients of a test note here what they received.
class QuickQueries : public ::testing::Test {
 protected:
  QuickQueries() {
    NodeSetup setup;
    setup.params = dict({{"world_frame", "world"},
                         {"robots", list({dict({{"name", "none"}, {"description", "robot_description"}})})},
                         {"accept_uncovered", list({waiver("none/*", "there is no robot")})},
                         {"obstacles", obstacles()}});
    setup.beside["robot_description"] = urdf(link("world"));
    node_ = std::make_unique<NodeUnderTest>(setup);
    node_->waitForComplete();
  }
  std::string service() const { return node_->named("query_sphere"); }
  /// Lets the clients run for 2 s.
  void start() { end_ = std::chrono::steady_clock::now() + std::chrono::seconds(2); }
  bool running() const { return std::chrono::steady_clock::now() < end_; }
  void check(std::size_t i, const msg::QuerySphere::Response& response) {
    ++answers_;
    wrong_ += isAnswer(i, response) ? 0 : 1;
  }
  /// Sends requests in bursts without waiting for the answers.
  void sendBursts(std::size_t length) {
    try {
      OpenConnection connection(service());
      for (std::size_t first = 0; running(); first += length) {
        for (std::size_t i = first; i < first + length; ++i) {
          if (!connection.send(requestOf(i))) throw std::runtime_error("a request cannot be sent");
        }
        for (std::size_t i = first; i < first + length; ++i) check(i, connection.receive());
      }
    } catch (const std::exception&) {
      ++lost_;
    }
  }
  /// Calls the service as other nodes do.
  void call() {
    ros::ServiceClient client = ros::NodeHandle().serviceClient<msg::QuerySphere>(service(), true);
    for (std::size_t i = 0; running(); ++i) {
      msg::QuerySphere question;
      question.request = requestOf(i);
      if (!client.call(question)) {
        ++lost_;
        return;
      }
      check(i, question.response);
    }
  }
  /// Calls the service 20 times for the obstacles at x = -10 m.
  void askForHeap(double radius, std::size_t hits) {
    ros::ServiceClient client = ros::NodeHandle().serviceClient<msg::QuerySphere>(service(), true);
    msg::QuerySphere question;
    question.request.center.x = -10.0;
    question.request.radius = radius;
    for (int i = 0; i < 20; ++i) {
      EXPECT_TRUE(client.call(question));
      EXPECT_EQ(question.response.answer.hits.size(), hits);
      ++answers_;
    }
  }
  /// Returns how many of all calls so far were answered in the receiving thread.
  std::uint64_t quickAnswers() {
    const auto all_asked = [&](const msg::Status& status) { return counter(status, "query.asked") == answers_; };
    return counter(*node_->waitForStatus("all calls", all_asked), "query.quick");
  }
  /// Does this until a call was answered in the receiving thread. If other programs keep the processors busy, each
  /// search may take longer than such an answer may.
  void untilOneIsQuick(const std::function<void()>& ask) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (quickAnswers() == 0 && std::chrono::steady_clock::now() < end) ask();
    EXPECT_GT(quickAnswers(), 0u);
  }
  void expectAllWell() {
    EXPECT_EQ(wrong_, 0u);
    EXPECT_EQ(lost_, 0u);
    EXPECT_LT(quickAnswers(), answers_);
  }

  std::unique_ptr<NodeUnderTest> node_;
  std::chrono::steady_clock::time_point end_;
  std::atomic<std::size_t> answers_{0}, wrong_{0}, lost_{0};
};

TEST_F(QuickQueries, AreAnsweredToAClientThatAsksWithoutAPause) {
  untilOneIsQuick([this] {
    start();
    sendBursts(1);
  });
  expectAllWell();
}

TEST_F(QuickQueries, HaveAtMost64Hits) {
  askForHeap(1.5, 65);
  EXPECT_EQ(quickAnswers(), 0u);
  untilOneIsQuick([this] { askForHeap(0.5, 64); });
}

TEST_F(QuickQueries, AreAnsweredToManyClientsWhileTheNodeReceivesTransforms) {
  TransformSource transforms;
  std::vector<std::thread> clients;
  start();
  for (int i = 0; i < 2; ++i) {
    clients.emplace_back([this] { call(); });
    clients.emplace_back([this] { sendBursts(20); });
  }
  std::uint64_t sent = 0;
  for (; running(); ++sent) {
    transforms.send({stamped("world", "mover", at(0), ros::Time::now())});
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  for (std::thread& client : clients) client.join();
  expectAllWell();
  node_->waitForStatus("all transforms", [&](const auto& status) { return counter(status, "tf.accepted") == sent; });
}

}  // namespace
}  // namespace test
}  // namespace hgrid
