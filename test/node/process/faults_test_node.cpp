// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The node with a narrow phase that throws exceptions for tests. The parameter ~fault names the function that throws;
// ~fault_kind is the kind of the exception. While ~fault is "hang", measurements do not end, and ~hanging is the number
// of those that have begun to hang. If the environment variable HGRID_MOST_THREADS is set, the node can create only so
// many threads, not counting those of roscpp. The exit code is 2 if the node destroys its parts while threads still use
// them.
#include <dlfcn.h>
#include <pthread.h>
#include <ros/ros.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <limits>
#include <memory>
#include <new>
#include <stdexcept>

#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "src/node/process/proximity_node.h"

namespace {

std::atomic<int> g_threads_left{std::numeric_limits<int>::max()};  // number of threads that can still be created
std::atomic<int> g_threads_alive{0};

struct ThreadStart {
  void* (*function)(void*);
  void* argument;
};

void* countWhileAlive(void* start) {
  const std::unique_ptr<ThreadStart> given(static_cast<ThreadStart*>(start));
  void* const result = given->function(given->argument);
  --g_threads_alive;
  return result;
}

}  // namespace

/// Replaces the function of the system. Counts the threads, and fails when no thread is left.
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*function)(void*),
                              void* argument) {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const Create create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  if (g_threads_left-- <= 0) return EAGAIN;
  ++g_threads_alive;
  auto start = std::make_unique<ThreadStart>(ThreadStart{function, argument});
  const int error = create(thread, attributes, countWhileAlive, start.get());
  if (error == 0) {
    start.release();
  } else {
    --g_threads_alive;
  }
  return error;
}

namespace hgrid {
namespace {

class FaultyPhase final : public NarrowPhase {
 public:
  /// The node destroys this object last, so the threads of the node must have ended. Only the thread of roscpp for
  /// timers may still run.
  ~FaultyPhase() override {
    if (g_threads_alive > alive_before_ + 1) std::_Exit(2);
  }
  std::shared_ptr<const Solid> solidOf(const Shape& shape) override {
    throwIf("solidOf");
    return sound_->solidOf(shape);
  }
  std::shared_ptr<const Solid> plane() const override { return sound_->plane(); }
  std::shared_ptr<const Solid> point() const override { return sound_->point(); }
  std::shared_ptr<const Solid> needle(double length) const override { return sound_->needle(length); }
  std::shared_ptr<const Solid> block(const Eigen::Vector3d& size) const override {
    throwIf("block");
    return sound_->block(size);
  }
  Proximity measure(const PlacedSolid& first, const PlacedSolid& second, double up_to) const override {
    throwIf("measure");
    if (isFault("hang")) ros::param::set("~hanging", ++hanging_);
    while (isFault("hang") && ros::ok()) {
    }
    return sound_->measure(first, second, up_to);
  }
  Contact measureContact(const PlacedSolid& first, const PlacedSolid& second) const override {
    return sound_->measureContact(first, second);
  }
  std::vector<Contact> contacts(const PlacedSolid& first, const PlacedSolid& second, std::size_t most) const override {
    throwIf("contacts");
    return sound_->contacts(first, second, most);
  }

 private:
  static bool isFault(const std::string& fault) {
    std::string now;
    return ros::param::get("~fault", now) && now == fault;
  }
  static void throwIf(const std::string& function) {
    std::string kind;
    if (!isFault(function)) return;
    ros::param::get("~fault_kind", kind);
    if (kind == "int") throw 1;
    if (kind == "memory") throw std::bad_alloc();
    throw std::runtime_error("a fault in " + function);
  }
  const int alive_before_ = g_threads_alive;
  mutable std::atomic<int> hanging_{0};
  std::shared_ptr<NarrowPhase> sound_ = makeCoreNarrowPhase();
};

}  // namespace
}  // namespace hgrid

int main(int argc, char** argv) {
  ros::init(argc, argv, "proximity");
  ros::NodeHandle node, private_node("~");
  if (const char* most = std::getenv("HGRID_MOST_THREADS")) g_threads_left = std::atoi(most);
  try {
    const hgrid::ProximityNode proximity(node, private_node, std::make_shared<hgrid::FaultyPhase>());
    ros::waitForShutdown();
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}
