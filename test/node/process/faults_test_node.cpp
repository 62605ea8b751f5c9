// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The node with a narrow phase that throws exceptions for tests. The parameter ~fault names the function that throws;
// ~fault_kind is the kind of the exception.
#include <ros/ros.h>

#include <new>
#include <stdexcept>

#include "hgrid_proximity/adapters/fcl.h"
#include "src/node/proximity_node.h"

namespace hgrid {
namespace {

class FaultyPhase final : public NarrowPhase {
 public:
  std::shared_ptr<const Solid> solidOf(const Shape& shape) override {
    throwIf("solidOf");
    return sound_->solidOf(shape);
  }
  std::shared_ptr<const Solid> point() const override { return sound_->point(); }
  std::shared_ptr<const Solid> needle(double length) const override { return sound_->needle(length); }
  std::shared_ptr<const Solid> block(const Eigen::Vector3d& size) const override {
    throwIf("block");
    return sound_->block(size);
  }
  Proximity measure(const PlacedSolid& first, const PlacedSolid& second, double up_to) const override {
    throwIf("measure");
    return sound_->measure(first, second, up_to);
  }
  std::vector<Contact> contacts(const PlacedSolid& first, const PlacedSolid& second, std::size_t most) const override {
    throwIf("contacts");
    return sound_->contacts(first, second, most);
  }

 private:
  static void throwIf(const std::string& function) {
    std::string fault, kind;
    if (!ros::param::get("~fault", fault) || fault != function) return;
    ros::param::get("~fault_kind", kind);
    if (kind == "int") throw 1;
    if (kind == "memory") throw std::bad_alloc();
    throw std::runtime_error("a fault in " + function);
  }
  std::shared_ptr<NarrowPhase> sound_ = makeFclNarrowPhase();
};

}  // namespace
}  // namespace hgrid

int main(int argc, char** argv) {
  ros::init(argc, argv, "proximity");
  ros::NodeHandle node, private_node("~");
  const hgrid::ProximityNode proximity(node, private_node, std::make_shared<hgrid::FaultyPhase>());
  ros::waitForShutdown();
}
