// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// If a message or service changes, the interface version must change as well.
#include <gtest/gtest.h>
#include <hgrid_proximity/AllowedPair.h>
#include <hgrid_proximity/Answer.h>
#include <hgrid_proximity/ApplyObstacles.h>
#include <hgrid_proximity/ApplyRobots.h>
#include <hgrid_proximity/Bodies.h>
#include <hgrid_proximity/Body.h>
#include <hgrid_proximity/BodyStatus.h>
#include <hgrid_proximity/CheckEdges.h>
#include <hgrid_proximity/CheckStates.h>
#include <hgrid_proximity/ClearMap.h>
#include <hgrid_proximity/ClockOffset.h>
#include <hgrid_proximity/Code.h>
#include <hgrid_proximity/Conflicts.h>
#include <hgrid_proximity/Counter.h>
#include <hgrid_proximity/Distances.h>
#include <hgrid_proximity/Events.h>
#include <hgrid_proximity/DistanceField.h>
#include <hgrid_proximity/ExplainPair.h>
#include <hgrid_proximity/Gauge.h>
#include <hgrid_proximity/GetAllowed.h>
#include <hgrid_proximity/Hit.h>
#include <hgrid_proximity/Lease.h>
#include <hgrid_proximity/Guard.h>
#include <hgrid_proximity/LoadOctomap.h>
#include <hgrid_proximity/LoadScene.h>
#include <hgrid_proximity/Obstacle.h>
#include <hgrid_proximity/Pairs.h>
#include <hgrid_proximity/Poses.h>
#include <hgrid_proximity/QueryBatch.h>
#include <hgrid_proximity/QueryBox.h>
#include <hgrid_proximity/QueryNearest.h>
#include <hgrid_proximity/QuerySegment.h>
#include <hgrid_proximity/QueryShape.h>
#include <hgrid_proximity/QuerySphere.h>
#include <hgrid_proximity/ReloadRobot.h>
#include <hgrid_proximity/RobotChange.h>
#include <hgrid_proximity/Rules.h>
#include <hgrid_proximity/SaveScene.h>
#include <hgrid_proximity/SelfPairs.h>
#include <hgrid_proximity/SetAllowed.h>
#include <hgrid_proximity/Shape.h>
#include <hgrid_proximity/SourceStatus.h>
#include <hgrid_proximity/Status.h>
#include <hgrid_proximity/Timing.h>
#include <hgrid_proximity/WorldState.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "src/node/messages/interface_version.h"

namespace hgrid {
namespace test {
namespace {

namespace msg = ::hgrid_proximity;

constexpr std::uint32_t kPinnedVersion = 8;  // interface version of the MD5 sums below

/// A message or service file, its MD5 sum, and the MD5 sum that it must have in this interface version.
struct Pin {
  std::string file, sum, pinned;
};

template <class Message>
Pin message(const std::string& name, const std::string& pinned) {
  return {"msg/" + name + ".msg", ros::message_traits::MD5Sum<Message>::value(), pinned};
}
template <class Service>
Pin service(const std::string& name, const std::string& pinned) {
  return {"srv/" + name + ".srv", ros::service_traits::MD5Sum<Service>::value(), pinned};
}

const std::vector<Pin>& pins() {
  static const std::vector<Pin> all = {
      message<msg::AllowedPair>("AllowedPair", "8390cbfa1b3008a47ee452ac3fbbaae3"),
      message<msg::Answer>("Answer", "e7fda3f60c57714b74d7003537f2645f"),
      message<msg::Bodies>("Bodies", "458d873717eb35b0ae8756fdaae4f151"),
      message<msg::Body>("Body", "d6c40cb1c4173b0c8016fbda0d22a3ea"),
      message<msg::BodyStatus>("BodyStatus", "bd9a63f6ebcd25ae08ba8cfb73a999f9"),
      message<msg::ClockOffset>("ClockOffset", "6b175ebc36db775a914a87e14972cd62"),
      message<msg::Code>("Code", "fbde2bf6467e5dfdc09bc3548840c269"),
      message<msg::Conflicts>("Conflicts", "aaaebd48d4d1a1f1ca0e176745ac3569"),
      message<msg::Counter>("Counter", "a8105c30af3c5e6c9a9f5ea2544709f5"),
      message<msg::Distances>("Distances", "80f4986367b9445b4f4505a8a46da144"),
      message<msg::Events>("Events", "2d3c7209582b0e49fec6219c5906fe1a"),
      message<msg::Gauge>("Gauge", "d8512f27253c0f65f928a67c329cd658"),
      message<msg::Hit>("Hit", "b27873b5bc9c5faff607ee93c2082a9f"),
      message<msg::Obstacle>("Obstacle", "5608eedc0bae1cab90887c5e86e8f978"),
      message<msg::Pairs>("Pairs", "59a5c05dcc80fa7bab33a476f547a113"),
      message<msg::Poses>("Poses", "3b5d47fb4ea85b737dd5eb0fc134064d"),
      message<msg::RobotChange>("RobotChange", "27a18441450869f732ed28206eff65a6"),
      message<msg::Rules>("Rules", "79058cafa5b4aab9f804a71d629c5134"),
      message<msg::SelfPairs>("SelfPairs", "5eb242595ef409da6cb975008f1ff334"),
      message<msg::Shape>("Shape", "61b71820d028a78f9c0114ba95225d3a"),
      message<msg::SourceStatus>("SourceStatus", "5d4419b44e109dac842346aa9930398a"),
      message<msg::Status>("Status", "51359a8c0fc26c3cdf24786276194ced"),
      message<msg::Timing>("Timing", "ffa7e14ed99c15133b8734e32bdf8366"),
      message<msg::Lease>("Lease", "f42ec0bd4d9e2aedc5b12b61edaec0ca"),
      message<msg::WorldState>("WorldState", "6e7f0e7ad23b6a55d3f532ba2a769931"),
      service<msg::ApplyObstacles>("ApplyObstacles", "f52ed5b3192f3c3a90fdc43ee3f2801d"),
      service<msg::ApplyRobots>("ApplyRobots", "7c47cace6728675cd273ddc573cd5ece"),
      service<msg::ClearMap>("ClearMap", "142d3d4665d9a7e8d3b73696517804d0"),
      service<msg::DistanceField>("DistanceField", "fdf9c3c3da1699bc85c0867411243ca8"),
      service<msg::ExplainPair>("ExplainPair", "7f877c8d05130f963b17495385f7f1f0"),
      service<msg::GetAllowed>("GetAllowed", "a7c3ddc68c8114168a385cee5844a3f2"),
      service<msg::Guard>("Guard", "a6bf946777eaf3eba6edd3c33b064b4a"),
      service<msg::LoadOctomap>("LoadOctomap", "93e62be52a707156933524d97672cc2d"),
      service<msg::QueryBatch>("QueryBatch", "7d59c04f9a167fdf1698108ee85346c5"),
      service<msg::QueryBox>("QueryBox", "8b378a163990ffc39d9443cb21832dd5"),
      service<msg::CheckEdges>("CheckEdges", "3cfce5225fb02d943b60318611c91353"),
      service<msg::CheckStates>("CheckStates", "cb82fcc35a69c98c9b394d7d9c9c0303"),
      service<msg::QueryNearest>("QueryNearest", "1c536a184c73768c2d7173dd305db8f6"),
      service<msg::QuerySegment>("QuerySegment", "83354b4bfa81d8e0a19b2fb48ee25859"),
      service<msg::QueryShape>("QueryShape", "76efaeb6fe39032be58a9723037afe87"),
      service<msg::QuerySphere>("QuerySphere", "8d1bde871426c698cbcc9a957b9511ad"),
      service<msg::LoadScene>("LoadScene", "0f60ed149b20c1e7f0f9d60b39f74b52"),
      service<msg::ReloadRobot>("ReloadRobot", "c148d85435550cf328927baad9e10cd7"),
      service<msg::SaveScene>("SaveScene", "c79d6e24b5e6e429b7bf1564478b72e1"),
      service<msg::SetAllowed>("SetAllowed", "c60f7338bb2a4f5a788d3f5cf3a66a0c"),
  };
  return all;
}

/// Returns whether pins() must contain a type: the first comment of its file does not say "Constants only".
bool mustBePinned(const std::filesystem::path& file) {
  std::ifstream text(file);
  for (std::string line; std::getline(text, line) && line.substr(0, 1) == "#";) {
    if (line.find("Constants only") != std::string::npos) return false;
  }
  return true;
}

TEST(InterfaceVersion, GrowsWhenAMessageOrServiceChanges) {
  for (const Pin& pin : pins()) {
    if (kInterfaceVersion != kPinnedVersion) break;
    EXPECT_EQ(pin.sum, pin.pinned)
        << pin.file << " has changed: raise kInterfaceVersion in src/node/messages/interface_version.h by one, then "
        << "write the new sums and the new kPinnedVersion into this test.";
  }
  EXPECT_EQ(kInterfaceVersion, kPinnedVersion) << "write the new sums and the new kPinnedVersion into this test.";
}

TEST(InterfaceVersion, StandsForEveryTypeWithFields) {
  const std::filesystem::path root = HGRID_PROJECT_DIR;
  std::size_t found = 0;
  for (const char* folder : {"msg", "srv"}) {
    for (const auto& entry : std::filesystem::directory_iterator(root / folder)) {
      const std::string file = std::string(folder) + "/" + entry.path().filename().string();
      const bool pinned = std::any_of(pins().begin(), pins().end(), [&](const Pin& pin) { return pin.file == file; });
      EXPECT_EQ(pinned, mustBePinned(entry.path())) << file << ": add it to pins(), or remove it from pins()";
      found += pinned ? 1 : 0;
    }
  }
  EXPECT_EQ(found, pins().size());
}

}  // namespace
}  // namespace test
}  // namespace hgrid
