// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "own_master.h"

#include <XmlRpcClient.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <thread>

#include "registrations.h"

namespace hgrid {
namespace test {
namespace {

constexpr auto kPatience = std::chrono::seconds(20);

/// Asks the master at this port of 127.0.0.1 for its state, a list of all publishers, subscribers and services.
/// @returns an invalid value if the master does not answer
XmlRpc::XmlRpcValue stateOf(int port) {
  XmlRpc::XmlRpcClient client("127.0.0.1", port, "/");
  XmlRpc::XmlRpcValue request, answer;
  request[0] = "/shutdown_test";
  if (!client.execute("getSystemState", request, answer) || client.isFault()) return {};
  return answer[2];
}

/// Checks the condition again and again, because a master sends no message when it starts or when a node registers.
template <class Condition>
void waitFor(const std::string& what, Condition&& holds) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!holds()) {
    if (std::chrono::steady_clock::now() > deadline) throw std::runtime_error("waited 20 s for: " + what);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

}  // namespace

int freePort() {
  std::random_device random;
  std::uniform_int_distribution<int> below_those_of_connections(20000, 32767);  // Linux takes ports from 32768 on
  for (int attempt = 0; attempt < 1000; ++attempt) {
    const int port = below_those_of_connections(random);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    const bool is_free = bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof(address)) == 0;
    close(socket);
    if (is_free) return port;
  }
  throw std::runtime_error("no free port on 127.0.0.1 from 20000 to 32767");
}

OwnMaster::OwnMaster() : port_(freePort()) {
  const std::vector<std::string> command{"rosmaster", "--core", "-p", std::to_string(port_)};
  process_ = std::make_unique<ChildProcess>(command, "/dev/null", std::map<std::string, std::string>{});
  waitFor("the first answer of a master", [&] { return stateOf(port_).valid(); });
}

std::vector<std::string> OwnMaster::registrations(const std::string& node) const {
  const XmlRpc::XmlRpcValue state = stateOf(port_);
  if (!state.valid()) throw std::runtime_error("the master does not answer getSystemState");
  return registrationsOf(node, state);
}

void OwnMaster::waitForRegistration(const std::string& node, const std::string& what) const {
  waitFor("'" + what + "' by " + node, [&] {
    const std::vector<std::string> all = registrations(node);
    return std::find(all.begin(), all.end(), what) != all.end();
  });
}

}  // namespace test
}  // namespace hgrid
