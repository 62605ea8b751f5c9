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
#include <hgrid_proximity/DistanceField.h>
#include <hgrid_proximity/Distances.h>
#include <hgrid_proximity/Events.h>
#include <hgrid_proximity/ExplainPair.h>
#include <hgrid_proximity/Gauge.h>
#include <hgrid_proximity/GetAllowed.h>
#include <hgrid_proximity/Guard.h>
#include <hgrid_proximity/Hit.h>
#include <hgrid_proximity/Lease.h>
#include <hgrid_proximity/ListScenes.h>
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
#include <sstream>
#include <string>
#include <vector>

#include "src/node/messages/interface_version.h"

namespace hgrid {
namespace test {
namespace {

namespace msg = ::hgrid_proximity;

constexpr std::uint32_t kPinnedVersion = 11;  // interface version of the MD5 sums below

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
      message<msg::Answer>("Answer", "996d9df91376306046f1acf6191c77c3"),
      message<msg::Bodies>("Bodies", "458d873717eb35b0ae8756fdaae4f151"),
      message<msg::Body>("Body", "d6c40cb1c4173b0c8016fbda0d22a3ea"),
      message<msg::BodyStatus>("BodyStatus", "bd9a63f6ebcd25ae08ba8cfb73a999f9"),
      message<msg::ClockOffset>("ClockOffset", "6b175ebc36db775a914a87e14972cd62"),
      message<msg::Code>("Code", "fbde2bf6467e5dfdc09bc3548840c269"),
      message<msg::Conflicts>("Conflicts", "a33e6e762757a2241cdc171f67af87c7"),
      message<msg::Counter>("Counter", "a8105c30af3c5e6c9a9f5ea2544709f5"),
      message<msg::Distances>("Distances", "8c66db7c3acd42ca3204ef533290e1a8"),
      message<msg::Events>("Events", "f867822512a8b744126c01237c5f2901"),
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
      service<msg::ApplyObstacles>("ApplyObstacles", "6f93a7e1f8dc10e8cdb209ffd7b5876a"),
      service<msg::ApplyRobots>("ApplyRobots", "5c89c5002cdad88d2555cfab3f212f56"),
      service<msg::ClearMap>("ClearMap", "65ed5eef6a74eb1f1a4be63c62d5b1da"),
      service<msg::DistanceField>("DistanceField", "bfd4a4272ef20a442d7dbe30be5e8e47"),
      service<msg::ExplainPair>("ExplainPair", "457360a42821f6b55053adaf3d496f5e"),
      service<msg::GetAllowed>("GetAllowed", "9fed1122aeeb905b4c7f36a169ae06d9"),
      service<msg::Guard>("Guard", "da13f334588c579b93b7bc7410ae0796"),
      service<msg::LoadOctomap>("LoadOctomap", "e4f109c1d659ff38a9cdcd1bef0eef96"),
      service<msg::QueryBatch>("QueryBatch", "ff849843809738b3532005ab891c379e"),
      service<msg::QueryBox>("QueryBox", "11811cca3f76b2e5b5c5193d3c3b97df"),
      service<msg::CheckEdges>("CheckEdges", "96016d09d43a8f7349c287eebf78e6cf"),
      service<msg::CheckStates>("CheckStates", "a145347a472bac90a4fa7e9a6217e2d2"),
      service<msg::QueryNearest>("QueryNearest", "4b5dee0806d6834dea30463f0e89a73d"),
      service<msg::QuerySegment>("QuerySegment", "59a89bd9d550c80ecdbad0dc9d089262"),
      service<msg::QueryShape>("QueryShape", "1c515b40df3e57bf697fe27ec588270d"),
      service<msg::QuerySphere>("QuerySphere", "cbb9e20e07adc0ac2ed9dca0d4806220"),
      service<msg::ListScenes>("ListScenes", "8ccdfa539449bd8cfb6d4ef1fec25066"),
      service<msg::LoadScene>("LoadScene", "7e476d3490cbefd0cc94d14df2c3b8ab"),
      service<msg::ReloadRobot>("ReloadRobot", "c5ae5f72eca260c90ca3f43adb386cf8"),
      service<msg::SaveScene>("SaveScene", "e2ef1526fa8e3192d368c6e403842089"),
      service<msg::SetAllowed>("SetAllowed", "8b7c12667844d46cf8314b0d66dc53f9"),
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

/// Claim: who prints an answer reads first what it says. Which data it is from stands at the end.
TEST(Answers, BeginWithWhatTheySayAndEndWithTheWorld) {
  const auto fieldsOf = [](const std::string& text) {
    std::vector<std::string> names;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string type, name;
      if (words >> type >> name && type[0] != '#') names.push_back(name);
    }
    return names;
  };
  const std::filesystem::path root = HGRID_PROJECT_DIR;
  const auto textOf = [](const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  };
  EXPECT_EQ(fieldsOf(textOf(root / "msg/Answer.msg")).front(), "summary");
  std::size_t services = 0;
  for (const auto& entry : std::filesystem::directory_iterator(root / "srv")) {
    SCOPED_TRACE(entry.path().filename());
    const std::string text = textOf(entry.path());
    const std::vector<std::string> fields = fieldsOf(text.substr(text.find("\n---\n") + 5));
    const auto has = [&](const std::string& name) { return std::count(fields.begin(), fields.end(), name) != 0; };
    EXPECT_EQ(fields.front(), has("answer") ? "answer" : has("explanation") ? "explanation" : "success");
    if (has("world")) {
      EXPECT_EQ(fields.back(), "world");
    }
    if (has("header")) {
      EXPECT_EQ(fields[fields.size() - 2], "header");
    }
    ++services;
  }
  EXPECT_GE(services, 21u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
