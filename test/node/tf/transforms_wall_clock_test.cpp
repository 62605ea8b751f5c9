// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <hgrid_proximity/BodyState.h>
#include <hgrid_proximity/Verdict.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/raw_message.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

/// Tests that change the wall clock. libfaketime (package libfaketime) shifts the clock of the node. It reads the shift
/// from a file whenever the node reads the clock. The test itself shifts the stamps of its transforms. The steady clock
/// is not shifted.
class WallClock : public ::testing::Test {
 protected:
  WallClock() : transforms_([this] { return wallTime() + ros::Duration(shift_); }) { write(0.0); }
  ~WallClock() override { std::remove(file_.c_str()); }

  static std::string library() {
    for (const char* path : {"/usr/lib/x86_64-linux-gnu/faketime/libfaketimeMT.so.1",
                             "/usr/lib/aarch64-linux-gnu/faketime/libfaketimeMT.so.1"}) {
      if (access(path, R_OK) == 0) return path;
    }
    return {};
  }
  void write(double shift) {
    shift_ = shift;
    const std::string next = file_ + ".next";
    std::ofstream(next) << (shift < 0.0 ? "" : "+") << shift << "\n";
    std::rename(next.c_str(), file_.c_str());
  }

  NodeSetup underThisClock() const {
    NodeSetup setup;
    setup.environment = {{"LD_PRELOAD", library()},
                         {"FAKETIME_TIMESTAMP_FILE", file_},
                         {"FAKETIME_NO_CACHE", "1"},
                         {"DONT_FAKE_MONOTONIC", "1"},
                         {"FAKETIME_DONT_FAKE_MONOTONIC", "1"}};
    return setup;
  }

  double shift_ = 0.0;  // [s] current shift of the wall clock
  const std::string file_ = std::string(std::getenv("TMPDIR") ? std::getenv("TMPDIR") : "/tmp") + "/shifted_clock_" +
                            std::to_string(getpid());
  TransformSource transforms_;
};

TEST_F(WallClock, SettingItTakesNoCellOfACloudAway) {
  if (library().empty()) GTEST_SKIP() << "libfaketime is not installed";
  NodeSetup setup = underThisClock();
  setup.params["clouds"] = list({dict({{"name", "front"}, {"lifetime", 60.0}})});
  setup.beside["robot_description"] = balls({"a"});
  NodeUnderTest node(setup);
  ros::NodeHandle ros;
  const ros::Publisher publisher = ros.advertise<CloudBytes>(node.space() + "/cloud", 1);
  const auto verdict = [&] { return node.sphere(3.0, 0.0, 0.0, 0.1).answer.verdict; };
  node.waitUntil("a hit", [&](const Heard&) {
    publisher.publish(cloudOfOne("base", transforms_.now(), 3.0f, 0.0f, 0.0f));
    return verdict() == msg::Verdict::HIT;
  });
  for (const double shift : {3600.0, 0.0, -3600.0}) {
    SCOPED_TRACE(shift);
    write(shift);
    for (int look = 0; look < 20; ++look) {
      node.waitForTicks(1);
      ASSERT_EQ(verdict(), msg::Verdict::HIT);
    }
  }
}

TEST_F(WallClock, SettingItAgesNothing) {
  if (library().empty()) GTEST_SKIP() << "libfaketime is not installed";
  NodeSetup setup = underThisClock();
  setup.params = dict({{"late_after", 60.0}, {"stale_after", 120.0}, {"lost_after", 240.0}});
  setup.beside["robot_description"] = balls({"a", "b"});
  NodeUnderTest node(setup);
  transforms_.stream("base", "a", at(0));
  transforms_.stream("base", "b", at(0.25));
  node.waitForComplete();
  for (const double shift : {3600.0, 0.0, -3600.0}) {
    SCOPED_TRACE(shift);
    const auto epoch = node.heard().status.back()->world.epoch;
    std::size_t begin = 0;
    transforms_.pauseFor([&] {
      const ros::Time newest = transforms_.newestStamp();
      node.waitForStatus("the newest transforms", [&](const msg::Status& s) { return s.header.stamp >= newest; });
      begin = node.heard().status.size();
      write(shift);
    });
    const auto status = node.waitForStatus("fresh data by the new clock", [&](const msg::Status& s) {
      return std::abs((s.header.stamp - transforms_.now()).toSec()) < 60.0 && s.world.epoch != epoch &&
             s.world.sequence > 20;
    });
    EXPECT_LT((status->made - status->header.stamp).toSec(), 60.0);
    const Heard all = node.heard();
    for (std::size_t i = begin; i < all.status.size(); ++i) {
      EXPECT_LE(all.status[i]->world.worst_state, msg::BodyState::LATE);
      EXPECT_LT(all.status[i]->world.max_age, 60.0);
      EXPECT_TRUE(all.status[i]->world.complete);
    }
    EXPECT_EQ(namesOf(*all.pairs.back()), std::vector<std::string>({"robot/a|robot/b"}));
  }
}

}  // namespace
}  // namespace test
}  // namespace hgrid
