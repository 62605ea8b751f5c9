// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>

#include "hgrid_proximity/adapters/octomap.h"
#include "test/adapters/octomap_bytes.h"
#include "test/adapters/octomap_judge.h"
#include "test/adapters/temporary_folder.h"
#include "test/support/refusals.h"
#include "test/support/robots.h"

namespace hgrid {
namespace test {
namespace {

const OctomapFormat kBinary{"OcTree", true, 0.1}, kFull{"OcTree", false, 0.1};

Code dataCode(const OctomapFormat& format, const std::string& data, const OctomapOptions& options = {},
              std::string* sentence = nullptr) {
  return refusalOf([&] { readOctomapData(format, data, "map 'm'", options); }, sentence);
}

Code fileCode(const std::string& file, std::string* sentence = nullptr, const OctomapOptions& options = {}) {
  return refusalOf([&] { readOctomap(file, "map 'm'", options); }, sentence);
}

/// Returns the `.bt` nodes of a small map: a root with two leaves and one inner node, which has one leaf.
std::string smallBt() { return btNode("of.....n") + btNode("...o...."); }
/// Returns the `.ot` nodes of a small map: a root with one leaf and one inner node, which has one leaf.
std::string smallOt() { return otNode(1.0f, 0x81) + otNode(2.0f) + otNode(-1.0f, 8) + otNode(-1.0f); }

TEST(OctomapBad, EveryPrefixOfAMapIsTruncated) {
  std::vector<WrittenMap> maps = {{kBinary, smallBt(), btHeader("# any\r\n" + usualLines("5")) + smallBt()},
                                  {kFull, smallOt(), otHeader(usualLines("4")) + smallOt()}};
  for (const char* id : {"OcTree", "ColorOcTree"}) {
    for (const bool binary : {true, false}) {
      unsigned seed = 0;
      WrittenMap map;
      do {
        Random random(++seed);
        map = randomMap(random, id, binary);
      } while (map.file.size() < 1000 || map.file.size() > 10000);  // the test time grows with size squared
      maps.push_back(map);
    }
  }
  for (const WrittenMap& map : maps) {
    SCOPED_TRACE(map.file.substr(0, 90));
    ASSERT_EQ(fileCode(map.file), Code::ok);
    ASSERT_EQ(dataCode(map.format, map.data), Code::ok);
    for (std::size_t cut = 0; cut < map.file.size(); ++cut) {
      ASSERT_EQ(fileCode(map.file.substr(0, cut)), Code::truncated) << "file cut at " << cut;
    }
    for (std::size_t cut = 1; cut < map.data.size(); ++cut) {
      ASSERT_EQ(dataCode(map.format, map.data.substr(0, cut)), Code::truncated) << "data cut at " << cut;
    }
  }
  std::string sentence;
  EXPECT_EQ(dataCode(kFull, smallOt().substr(0, 12), {}, &sentence), Code::truncated);
  EXPECT_TRUE(says(sentence, "map 'm' ends after 12 bytes"));
}

TEST(OctomapBad, AFileThatShrinksWhileItIsReadIsTruncated) {
  const TemporaryFolder folder;
  const std::string file = btHeader(usualLines("5")) + smallBt(), path = folder.write("m.bt", file);
  ResourcePolicy policy;
  policy.file_roots = {folder.path()};
  const OpenResource open = openResource("file://" + path, policy);
  EXPECT_EQ(readOctomapFile(open).occupied.size(), 2u);
  std::filesystem::resize_file(path, file.size() - 1);
  std::string sentence;
  EXPECT_EQ(refusalOf([&] { readOctomapFile(open); }, &sentence), Code::truncated);
  EXPECT_TRUE(says(sentence, path));
  EXPECT_TRUE(says(sentence, "after " + std::to_string(file.size() - 1) + " bytes"));
  OctomapOptions small;
  small.max_bytes = 10;
  EXPECT_EQ(refusalOf([&] { readOctomapFile(open, small); }, &sentence), Code::limit);
  EXPECT_TRUE(says(sentence, "at most 10"));
}

TEST(OctomapBad, NodesDeeperThanSixteenLevelsAreRefused) {
  std::string bt, ot;
  for (int depth = 0; depth < 16; ++depth) bt += btNode("n"), ot += otNode(1.0f, 1);
  EXPECT_EQ(dataCode(kBinary, bt + btNode("")), Code::ok) << "a node at depth 16 without children is allowed";
  EXPECT_EQ(dataCode(kFull, ot + otNode(1.0f)), Code::ok);
  for (int times : {1, 100000}) {
    std::string sentence, deeper_bt = bt, deeper_ot = ot;
    for (int i = 0; i < times; ++i) deeper_bt += btNode("n"), deeper_ot += otNode(1.0f, 1);
    EXPECT_EQ(dataCode(kBinary, deeper_bt + btNode("o"), {}, &sentence), Code::parse);
    EXPECT_TRUE(says(sentence, "deeper than 16"));
    EXPECT_EQ(dataCode(kFull, deeper_ot + otNode(1.0f)), Code::parse);
  }
}

TEST(OctomapBad, AResolutionIsANumberWithinItsBounds) {
  for (const double bad :
       {0.0, -1.0, 0.00099, 100.1, 1e-300, 1e300, double(NAN), double(INFINITY), -double(INFINITY)}) {
    std::string sentence;
    EXPECT_EQ(dataCode({"OcTree", true, bad}, smallBt(), {}, &sentence), Code::out_of_range) << bad;
    EXPECT_TRUE(says(sentence, text(bad)));
  }
  for (const double good : {0.001, 100.0}) EXPECT_EQ(dataCode({"OcTree", true, good}, smallBt()), Code::ok) << good;
  const std::vector<std::pair<std::string, Code>> in_files = {
      {"0", Code::out_of_range},     {"-1", Code::out_of_range}, {"1e-300", Code::out_of_range},
      {"1e300", Code::out_of_range}, {"nan", Code::parse},       {"inf", Code::parse},
      {"1e999", Code::parse},        {"0.1 0.2", Code::parse},   {"0,1", Code::parse},
      {"0x1", Code::parse},          {"0.1m", Code::parse},      {"1e-1", Code::ok}};
  for (const auto& [value, code] : in_files) {
    std::string sentence;
    EXPECT_EQ(fileCode(btHeader("id OcTree\nsize 5\nres " + value + "\n") + smallBt(), &sentence), code) << value;
    if (code == Code::ok) continue;
    EXPECT_TRUE(says(sentence, code == Code::parse ? "res '" + value + "'" : "resolution of"));
  }
}

TEST(OctomapBad, ASizeThatLiesIsRefused) {
  for (const char* size : {"0", "4", "6", "4294967295", "18446744073709551615", "-1", "1e30", "5.0", "five", "5 5",
                           "1000000000000000000000000000000"}) {
    std::string sentence;
    EXPECT_EQ(fileCode(btHeader(usualLines(size)) + smallBt(), &sentence), Code::parse) << size;
    EXPECT_TRUE(says(sentence, size));
  }
  EXPECT_EQ(fileCode(otHeader(usualLines("3")) + smallOt()), Code::parse);
  EXPECT_EQ(fileCode(otHeader(usualLines("4")) + smallOt()), Code::ok);
}

TEST(OctomapBad, OnlyTreesOfOccupancyAreRead) {
  for (const char* id : {"OcTreeStamped", "CountingOcTree", "octree", "1", "OcTree\nx"}) {
    std::string sentence;
    EXPECT_EQ(dataCode({id, true, 0.1}, smallBt(), {}, &sentence), Code::unsupported) << id;
    EXPECT_TRUE(says(sentence, printable(id)));
  }
  std::string sentence;
  EXPECT_EQ(dataCode({"", false, 0.1}, smallOt(), {}, &sentence), Code::unsupported);
  EXPECT_EQ(fileCode(otHeader("id SemanticOcTree\nsize 4\nres 0.1\n") + smallOt(), &sentence), Code::unsupported);
  EXPECT_TRUE(says(sentence, "'SemanticOcTree'"));
}

TEST(OctomapBad, AHeaderIsOneOfOctoMap) {
  std::string sentence;
  const std::string legacy("\3\0\0\0", 4);
  EXPECT_EQ(fileCode(legacy + std::string(12, 'x') + smallBt(), &sentence), Code::unsupported);
  EXPECT_TRUE(says(sentence, "before 1.0"));
  for (const std::string& strange : {std::string("solid mesh\n"), std::string("\n"), legacy.substr(0, 3), smallBt()}) {
    EXPECT_EQ(fileCode(strange, &sentence), Code::parse);
    EXPECT_TRUE(says(sentence, printable(strange)));
  }
  for (const char* key : {"id", "size", "res"}) {
    const std::string usual = usualLines("5"), line = std::string(key) + " ";
    const std::size_t at = usual.find(line), end = usual.find('\n', at) + 1;
    for (const std::string& instead : {std::string(), std::string(key) + "\n"}) {
      std::string lines = usual;
      EXPECT_EQ(fileCode(btHeader(lines.replace(at, end - at, instead)) + smallBt(), &sentence), Code::parse);
      EXPECT_TRUE(says(sentence, "'" + std::string(key) + "'"));
    }
    EXPECT_EQ(fileCode(btHeader(usual + usual.substr(at, end - at)) + smallBt(), &sentence), Code::parse);
    EXPECT_TRUE(says(sentence, "two header lines '" + std::string(key) + "'"));
  }
  EXPECT_EQ(fileCode(btHeader(usualLines("5") + "data 1\n") + smallBt(), &sentence), Code::parse);
  EXPECT_TRUE(says(sentence, "'data 1'"));
}

TEST(OctomapBad, AHeaderMayHaveOtherOrdersEndsAndComments) {
  const std::string headers[] = {
      btHeader("res 0.1\n# id Other\n\n  size\t5  \nid OcTree\n"),
      btHeader("unknown word\n" + usualLines("5")),
      "# Octomap OcTree binary file, and more\r\nid OcTree\r\nsize 5\r\nres 0.1\r\ndata\r\n",
      btHeader("#" + std::string(1023, '-') + "\n" + usualLines("5")),
  };
  for (const std::string& header : headers) EXPECT_EQ(fileCode(header + smallBt()), Code::ok) << header;
  std::string sentence;
  EXPECT_EQ(fileCode(btHeader("#" + std::string(1024, '-') + "\n" + usualLines("5")) + smallBt(), &sentence),
            Code::limit);
  EXPECT_TRUE(says(sentence, "1024 bytes"));
}

TEST(OctomapBad, DataWithoutANodeAreAMapOnlyWhereThatIsAllowed) {
  OctomapOptions allowed;
  allowed.allow_empty = true;
  std::string sentence;
  for (const OctomapFormat& format : {kBinary, kFull}) {
    EXPECT_EQ(dataCode(format, "", {}, &sentence), Code::parse);
    EXPECT_TRUE(says(sentence, "map 'm' is empty"));
    const Octomap map = readOctomapData(format, "", "map 'm'", allowed);
    EXPECT_TRUE(map.occupied.empty());
    EXPECT_EQ(map.nodes, 0u);
    EXPECT_EQ(map.resolution, 0.1);
  }
  for (const std::string& file : {btHeader(usualLines("0")), otHeader(usualLines("0"))}) {
    EXPECT_EQ(fileCode(file), Code::parse);
    EXPECT_EQ(fileCode(file, nullptr, allowed), Code::ok);
  }
  EXPECT_EQ(fileCode(btHeader(usualLines("5")), nullptr, allowed), Code::truncated);
  EXPECT_EQ(fileCode("", nullptr, allowed), Code::truncated) << "a file must have a header";
}

TEST(OctomapBad, BytesAfterTheTreeAreRefused) {
  for (const std::string& more : {std::string("\n"), std::string(1, '\0'), smallBt()}) {
    std::string sentence;
    EXPECT_EQ(dataCode(kBinary, smallBt() + more, {}, &sentence), Code::parse);
    EXPECT_TRUE(says(sentence, std::to_string(more.size()) + " bytes after the 4"));
    EXPECT_EQ(dataCode(kFull, smallOt() + more), Code::parse);
    EXPECT_EQ(fileCode(btHeader(usualLines("5")) + smallBt() + more), Code::parse);
  }
}

TEST(OctomapBad, BytesNodesAndLeavesHaveTheirLimits) {
  std::string sentence;
  OctomapOptions bytes, nodes, leaves;
  bytes.max_bytes = 3;
  EXPECT_EQ(dataCode(kBinary, smallBt(), bytes, &sentence), Code::limit);
  EXPECT_TRUE(says(sentence, "has 4 bytes; at most 3"));
  EXPECT_EQ(fileCode(btHeader(usualLines("5")) + smallBt(), &sentence, bytes), Code::limit);
  nodes.max_nodes = 4;
  EXPECT_EQ(dataCode(kBinary, smallBt(), nodes, &sentence), Code::limit);
  EXPECT_TRUE(says(sentence, "too many nodes; at most 4 are allowed"));
  EXPECT_EQ(dataCode(kFull, smallOt(), nodes), Code::ok) << "as many nodes as the limit are allowed";
  leaves.max_leaves = 1;
  EXPECT_EQ(dataCode(kBinary, smallBt(), leaves, &sentence), Code::limit);
  EXPECT_TRUE(says(sentence, "too many leaves to keep; at most 1 are allowed"));
  leaves.max_leaves = 2;
  EXPECT_EQ(dataCode(kBinary, smallBt(), leaves), Code::ok);
  leaves.keep_free = true;
  EXPECT_EQ(dataCode(kBinary, smallBt(), leaves), Code::limit) << "kept free leaves count toward the limit";
}

/// Returns the `.bt` nodes of a subtree that begins at this depth. `children` describes its first node, as in btNode().
/// Each child 'n' is completely occupied, down to the lowest level.
std::string fullTree(int depth, const std::string& children) {
  if (depth == 15) return btNode("oooooooo");
  const std::string below = fullTree(depth + 1, "nnnnnnnn");
  std::string bytes = btNode(children);
  for (const char child : children) bytes += child == 'n' ? below : "";
  return bytes;
}

/// Returns the `.bt` nodes of a tree: a single path down to this depth, and then fullTree().
std::string fullBelow(int depth, const std::string& children) {
  std::string path;
  for (int i = 0; i < depth; ++i) path += btNode("n");
  return path + fullTree(depth, children);
}

long peakKilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

// Two bytes of input create at most eight leaves of eight bytes each, even if unknown space counts as occupied. The
// limit of the number of nodes also limits the leaves.
TEST(OctomapBad, SmallInputsDoNotExpand) {
  const std::string data = fullBelow(12, "nnnnnnn.");
  ASSERT_LT(data.size(), 4096u);
  OctomapOptions options;
  options.unknown = UnknownSpace::occupied;
  const Octomap map = readOctomapData(kBinary, data, "map", options);
  EXPECT_EQ(map.occupied.size(), 7u * 8 * 8 * 8 + 1 + 12 * 7);
  EXPECT_LE(map.occupied.size() * sizeof(Voxel), 32 * data.size());
  options.max_nodes = 1000;
  std::string sentence;
  EXPECT_EQ(dataCode(kBinary, data, options, &sentence), Code::limit);
  EXPECT_TRUE(says(sentence, "too many nodes; at most 1000 are"));
}

TEST(OctomapBad, FiftyMillionLeavesAreRefusedAndTakeNoMemory) {
  const std::string data = fullBelow(7, "nnn.....");  // a map of 3 * 8^8 leaves
  ASSERT_GT(data.size(), 12u << 20);
  std::string sentence;
  OctomapOptions options;
  options.max_leaves = 1000000;
  options.max_nodes = 1000000000;
  const long before = peakKilobytes();
  EXPECT_EQ(dataCode(kBinary, data, options, &sentence), Code::limit);
  EXPECT_TRUE(says(sentence, "too many leaves to keep; at most 1000000 are"));
  EXPECT_LT(peakKilobytes() - before, 40 << 10);
  EXPECT_EQ(dataCode(kBinary, data), Code::limit) << "the default limits must refuse it, too";
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
// If the memory runs out before a limit is reached, the reader refuses the map with the code `limit`.
TEST(OctomapBad, MemoryThatRunsOutIsALimit) {
  const std::string data = fullBelow(7, "n.......");  // 8^8 leaves, which need 134 MB
  rlimit unlimited{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &unlimited), 0);
  rlimit tight = unlimited;
  tight.rlim_cur = 150u << 20;
  ASSERT_EQ(setrlimit(RLIMIT_AS, &tight), 0);
  std::string sentence;
  const Code code = dataCode(kBinary, data, {}, &sentence);
  setrlimit(RLIMIT_AS, &unlimited);
  EXPECT_EQ(code, Code::limit);
  EXPECT_TRUE(says(sentence, "memory"));
}
#endif

}  // namespace
}  // namespace test
}  // namespace hgrid
