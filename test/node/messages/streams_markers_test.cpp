// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <nodelet/loader.h>
#include <ros/param.h>
#include <ros/service.h>
#include <ros/this_node.h>
#include <visualization_msgs/MarkerArray.h>

#include <map>
#include <set>

#include "test/node/support/claims.h"
#include "test/node/support/descriptions.h"
#include "test/node/support/transform_source.h"

namespace hgrid {
namespace test {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

/// Receives a topic and stores all messages in their order.
template <class Message>
class Ear {
 public:
  explicit Ear(const std::string& topic)
      : subscriber_(node_.subscribe<Message>(topic, 1000, [this](const boost::shared_ptr<const Message>& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          heard_.push_back(message);
          news_.notify_all();
        })) {}
  /// Waits until there is a message for which `wanted` is true. Returns all messages so far.
  std::vector<boost::shared_ptr<const Message>> until(const std::function<bool(const Message&)>& wanted) {
    std::unique_lock<std::mutex> lock(mutex_);
    const bool came = news_.wait_for(lock, std::chrono::seconds(20), [&] {
      return std::any_of(heard_.begin(), heard_.end(), [&](const auto& message) { return wanted(*message); });
    });
    if (!came) throw std::runtime_error("the expected message did not come within 20 s");
    return heard_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable news_;
  std::vector<boost::shared_ptr<const Message>> heard_;
  ros::NodeHandle node_;
  ros::Subscriber subscriber_;
};

/// Returns whether a marker array adds a marker in this namespace.
bool draws(const MarkerArray& array, const std::string& layer) {
  return std::any_of(array.markers.begin(), array.markers.end(),
                     [&](const Marker& marker) { return marker.ns == layer && marker.action == Marker::ADD; });
}

TEST(Markers, ArePublishedForSubscribersAndBeginWithDeleteAll) {
  TransformSource transforms;
  NodeSetup setup;
  setup.params = dict({{"marker_rate", 50.0}, {"late_after", 0.1}, {"stale_after", 0.2}});
  setup.beside["robot_description"] = balls({"a", "b"});
  NodeUnderTest node(setup);
  transforms.stream("base", "a", at(0));
  transforms.stream("base", "b", at(0.25));
  node.waitForComplete();
  for (int viewer = 0; viewer < 2; ++viewer) {
    SCOPED_TRACE(viewer);
    Ear<MarkerArray> eye(node.named("markers"));
    const auto seen =
        eye.until([](const MarkerArray& array) { return draws(array, "shapes") && draws(array, "pairs"); });
    ASSERT_FALSE(seen.front()->markers.empty());
    EXPECT_EQ(seen.front()->markers[0].action, Marker::DELETEALL);
    std::set<std::pair<std::string, int>> ids;
    std::map<std::string, std::size_t> drawn;
    for (const Marker& marker : seen.back()->markers) {
      if (marker.action == Marker::DELETEALL) continue;
      EXPECT_EQ(marker.header.frame_id, "base");
      EXPECT_GT(marker.lifetime.toSec(), 3.0 / 50.0) << marker.ns << marker.id;
      EXPECT_LE(marker.lifetime.toSec(), 1.0) << "nothing stays in RViz after the end of the node";
      EXPECT_TRUE(ids.insert({marker.ns, marker.id}).second);
      drawn[marker.ns] += marker.action == Marker::ADD ? 1u : 0u;
    }
    EXPECT_EQ(drawn["shapes"], 3u);
    EXPECT_EQ(drawn["boxes"], 1u);
    EXPECT_EQ(drawn["pairs"], 2u) << "lines and dots";
    EXPECT_EQ(drawn["pair_numbers"], 1u);
    EXPECT_EQ(drawn["verdict"], 2u) << "the verdict and the list of pairs";
    EXPECT_EQ(drawn["states"], 0u);
    std::string texts;
    for (const Marker& marker : seen.back()->markers) texts += marker.ns == "verdict" ? marker.text : "";
    EXPECT_NE(texts.find("COMPLETE: 1 near pair\n"), std::string::npos) << texts;
    EXPECT_NE(texts.find("1. robot/a to robot/b: "), std::string::npos) << texts;
  }
  Ear<MarkerArray> eye(node.named("markers"));
  node.sphere(0, 0, 3, 0.5);
  node.segment(xyz(0, 0, 0), xyz(1, 0, 0), 0);
  eye.until([](const MarkerArray& array) { return draws(array, "queries"); });
  transforms.stop("b");
  eye.until([](const MarkerArray& array) { return draws(array, "states"); });
  eye.until([](const MarkerArray& array) {
    return std::any_of(array.markers.begin(), array.markers.end(),
                       [](const Marker& marker) { return marker.text.compare(0, 13, "NOT COMPLETE:") == 0; });
  });
}

TEST(Nodelet, ServesLikeTheNodeOnceItsParametersAreRight) {
  const std::string space = ros::this_node::getName(), name = space + "/proximity";
  nodelet::Loader manager(false);
  ros::param::set(name, dict({{"rate", "fast"}}));
  EXPECT_FALSE(manager.load(name, "hgrid_proximity/ProximityNodelet", {}, {})) << "the parameters are wrong";

  ros::param::set(name, dict({{"world_frame", "base"}, {"obstacles", list({ball("post", 2, 0, 0, 0.1)})}}));
  ros::param::set(space + "/robot_description", balls({}));
  ASSERT_TRUE(manager.load(name, "hgrid_proximity/ProximityNodelet", {}, {}));
  {
    Ear<msg::Status> ear(name + "/status");
    ear.until([](const msg::Status& status) { return status.world.complete && status.body_count == 2; });
  }
  msg::QuerySphere query;
  query.request.center.x = 2;
  ASSERT_TRUE(ros::service::call(name + "/query_sphere", query));
  EXPECT_EQ(namesOf(query.response.answer), std::vector<std::string>({"obstacle/post"}));
  EXPECT_TRUE(manager.unload(name));
}

}  // namespace
}  // namespace test
}  // namespace hgrid
