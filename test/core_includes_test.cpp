// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace hgrid {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = HGRID_PROJECT_DIR;
const std::vector<std::string> kRooms = {"geometry", "broadphase", "narrow",  "bodies",    "maps",   "pairs",
                                         "world",    "history",    "queries", "distances", "explain"};

/// Returns the header that a line includes; empty if it includes none.
std::string includedIn(const std::string& line) {
  const auto next = [&](std::size_t from) { return std::min(line.find_first_not_of(" \t", from), line.size()); };
  const std::size_t hash = next(0);
  if (line.compare(hash, 1, "#") != 0) return {};
  const std::size_t word = next(hash + 1);
  if (line.compare(word, 7, "include") != 0) return {};
  const std::size_t open = next(word + 7), close = line.find_first_of(">\"", open + 1);
  return open < line.size() && close != std::string::npos ? line.substr(open + 1, close - open - 1) : std::string();
}

/// Returns whether a file belongs to the core: it is directly in include/hgrid_proximity or src, or in a core room.
bool isCore(const fs::path& file) {
  for (const fs::path& side : {kRoot / "include/hgrid_proximity", kRoot / "src"}) {
    const fs::path inside = file.lexically_normal().lexically_relative(side);
    if (inside.empty() || *inside.begin() == "..") continue;
    const bool in_room = std::count(kRooms.begin(), kRooms.end(), inside.begin()->string()) != 0;
    return fs::is_regular_file(file) && (in_room || std::distance(inside.begin(), inside.end()) == 1);
  }
  return false;
}

/// Returns whether the core must not include a header. The core may include its own headers and those of the standard
/// library (without slash and dot), of Eigen and of the compiler's intrinsics.
bool isForeign(const std::string& header, const fs::path& folder) {
  const std::string intrinsics = "intrin.h";  // end of the names of x86 headers; the ARM header is arm_neon.h
  const bool standard = header.find_first_of("/.") == std::string::npos;
  const bool compiler = header.size() > intrinsics.size() && header.find('/') == std::string::npos &&
                        header.compare(header.size() - intrinsics.size(), intrinsics.size(), intrinsics) == 0;
  if (standard || compiler || header == "arm_neon.h" || header.compare(0, 6, "Eigen/") == 0) return false;
  return !isCore(folder / header) && !isCore(kRoot / "include" / header) && !isCore(kRoot / "src" / header);
}

TEST(CoreIncludes, TheCheckKnowsForeignFromOwn) {
  const fs::path folder = kRoot / "src/bodies";
  for (const char* foreign :
       {"ros/ros.h", "tf2/buffer_core.h", "urdf/model.h", "urdf_model/model.h", "fcl/fcl.h", "octomap/octomap.h",
        "tinyxml.h", "tinyxml2.h", "std_msgs/Header.h", "hgrid_proximity/Pairs.h", "hgrid_proximity/adapters/urdf.h",
        "adapters/urdf/xml.h", "node/world/world.h", "geometry_msgs/Pose.h", "partitions/partition.h",
        "hgrid_proximity/partitions/partitions.h"}) {
    EXPECT_TRUE(isForeign(foreign, folder)) << foreign;
  }
  for (const char* own : {"vector", "cstdint", "Eigen/Core", "immintrin.h", "hgrid_proximity/refusal.h", "../utf8.h",
                          "utf8.h", "hgrid_proximity/bodies/name.h"}) {
    EXPECT_FALSE(isForeign(own, folder)) << own;
  }
  EXPECT_EQ(includedIn("  # include  <ros/ros.h>  // why"), "ros/ros.h");
  EXPECT_EQ(includedIn("#include \"a/b.h\""), "a/b.h");
  EXPECT_EQ(includedIn("// #include <ros/ros.h>"), "");
  EXPECT_EQ(includedIn("#include"), "");
  EXPECT_EQ(includedIn(""), "");
}

TEST(CoreIncludes, NoCoreFileIncludesAForeignHeader) {
  std::vector<fs::path> files = {kRoot / "include/hgrid_proximity/refusal.h", kRoot / "src/refusal.cpp"};
  for (const std::string& room : kRooms) {
    for (const char* side : {"include/hgrid_proximity", "src"}) {
      ASSERT_TRUE(fs::is_directory(kRoot / side / room)) << side << "/" << room;
      for (const auto& entry : fs::recursive_directory_iterator(kRoot / side / room)) files.push_back(entry.path());
    }
  }
  std::size_t includes = 0;
  for (const fs::path& path : files) {
    std::ifstream file(path);
    int number = 0;
    for (std::string line; std::getline(file, line);) {
      ++number;
      const std::string header = includedIn(line);
      if (header.empty()) continue;
      ++includes;
      EXPECT_FALSE(isForeign(header, path.parent_path())) << path << ":" << number << " includes " << header;
    }
  }
  EXPECT_GT(files.size(), 20u);
  EXPECT_GT(includes, files.size()) << "too few include lines were read for a meaningful test";
}

/// Returns the index in kRooms of the room (folder) that contains a path below include/hgrid_proximity or src. Returns
/// kRooms.size() if no room contains the path.
std::size_t roomOf(const std::string& path) {
  const std::string room = path.substr(0, path.find('/'));
  return static_cast<std::size_t>(std::find(kRooms.begin(), kRooms.end(), room) - kRooms.begin());
}

/// Claim: a file of the core includes only files from its own room (folder) and from rooms before it in kRooms.
TEST(CoreIncludes, ARoomIncludesOnlyRoomsBeforeIt) {
  const std::string prefix = "hgrid_proximity/";
  std::size_t checked = 0;
  for (const fs::path& side : {kRoot / "include/hgrid_proximity", kRoot / "src"}) {
    for (const auto& entry : fs::recursive_directory_iterator(side)) {
      const std::size_t room = roomOf(entry.path().lexically_relative(side).generic_string());
      if (!entry.is_regular_file() || room == kRooms.size()) continue;
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);) {
        std::string header = includedIn(line);
        if (header.compare(0, prefix.size(), prefix) == 0) header.erase(0, prefix.size());
        const std::size_t used = roomOf(header);
        if (header.find('/') == std::string::npos || used == kRooms.size()) continue;
        ++checked;
        EXPECT_LE(used, room) << entry.path() << " includes " << header;
      }
    }
  }
  EXPECT_GT(checked, 200u);
}

/// Claim: a file of the node includes only files from its own folder and from folders before it in this list, and each
/// folder of the node is in the list.
TEST(NodeIncludes, AFolderIncludesOnlyFoldersBeforeIt) {
  const std::vector<std::string> folders = {
      "text",    "time",       "threads", "wire",     "params",  "health",      "tf",          "robots",  "tick",
      "sources", "messages",   "tracks",  "world",    "loading", "loop",        "state",       "queries", "states",
      "markers", "publishers", "guard",   "services", "moveit",  "reconfigure", "diagnostics", "audit",   "process"};
  const auto rankOf = [&](const std::string& folder) {
    return std::find(folders.begin(), folders.end(), folder) - folders.begin();
  };
  const std::string prefix = "node/";
  const fs::path side = kRoot / "src/node";
  std::size_t checked = 0;
  for (const auto& entry : fs::recursive_directory_iterator(side)) {
    if (!entry.is_regular_file()) continue;
    const std::string inside = entry.path().lexically_relative(side).generic_string();
    const auto rank = rankOf(inside.substr(0, inside.find('/')));
    ASSERT_LT(rank, rankOf("")) << inside << " is in no folder of the list";
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      const std::string header = includedIn(line);
      if (header.compare(0, prefix.size(), prefix) != 0) continue;
      ++checked;
      const std::string used = header.substr(prefix.size());
      EXPECT_LE(rankOf(used.substr(0, used.find('/'))), rank) << inside << " includes " << header;
    }
  }
  EXPECT_GT(checked, 800u);
}

/// Claim: the partitions include only each other and headers of the core's folders broadphase and geometry.
TEST(CoreIncludes, PartitionsIncludeOnlyBroadPhasesAndGeometry) {
  const std::vector<std::string> allowed = {"partitions/",
                                            "hgrid_proximity/partitions/",
                                            "hgrid_proximity/broadphase/",
                                            "hgrid_proximity/geometry/",
                                            "geometry/",
                                            "Eigen/"};
  std::size_t checked = 0;
  for (const char* folder : {"include/hgrid_proximity/partitions", "src/partitions"}) {
    for (const auto& entry : fs::directory_iterator(kRoot / folder)) {
      std::ifstream file(entry.path());
      for (std::string line; std::getline(file, line);) {
        const std::string header = includedIn(line);
        if (header.find_first_of("/.") == std::string::npos) continue;  // of the standard library
        ++checked;
        EXPECT_TRUE(std::any_of(allowed.begin(), allowed.end(),
                                [&](const std::string& start) { return header.compare(0, start.size(), start) == 0; }))
            << entry.path() << " includes " << header;
      }
    }
  }
  EXPECT_GT(checked, 50u);
}

/// Claim: code that is compiled for one instruction set includes no templates of the standard library or Eigen. The
/// linker could use the compiled templates everywhere, even on processors without this instruction set.
TEST(CoreIncludes, KernelsIncludeNoTemplates) {
  const std::vector<std::string> allowed = {"arm_neon.h", "cstddef", "cstdint", "emmintrin.h", "immintrin.h"};
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(kRoot / "src/broadphase/kernels")) {
    ++files;
    std::ifstream file(entry.path());
    for (std::string line; std::getline(file, line);) {
      const std::string header = includedIn(line);
      if (header.empty() || header.compare(0, 19, "broadphase/kernels/") == 0) continue;
      EXPECT_EQ(std::count(allowed.begin(), allowed.end(), header), 1) << entry.path() << " includes " << header;
    }
  }
  EXPECT_GE(files, 10u);
}

}  // namespace
}  // namespace hgrid
