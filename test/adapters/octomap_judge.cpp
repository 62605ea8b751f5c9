// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "test/adapters/octomap_judge.h"

#include <octomap/ColorOcTree.h>
#include <octomap/OcTree.h>

#include <chrono>
#include <sstream>
#include <stdexcept>

#include "hgrid_proximity/refusal.h"
#include "test/adapters/octomap_bytes.h"
#include "test/support/silence.h"

namespace hgrid {
namespace test {
namespace {

template <class Tree>
JudgedMap leavesOf(const Tree& tree) {
  JudgedMap map;
  for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
    const octomap::OcTreeKey key = leaf.getIndexKey();
    const auto level = static_cast<std::uint8_t>(tree.getTreeDepth() - leaf.getDepth());
    (tree.isNodeOccupied(*leaf) ? map.occupied : map.free).push_back({key[0], key[1], key[2], level});
  }
  map.nodes = tree.size();
  return map;
}

template <class Tree>
JudgedMap judgedAs(const OctomapFormat& format, const std::string& data, double occupied_from) {
  Tree tree(format.resolution);
  tree.setOccupancyThres(occupied_from);
  std::istringstream in(data);
  if (format.binary) {
    tree.readBinaryData(in);
  } else {
    tree.readData(in);
  }
  return leavesOf(tree);
}

/// Fills a cube with leaves of the finest level. A side of the cube is 1, 2, 4 or 8 leaves long.
template <class Tree>
void addCluster(Tree& tree, const octomap::OcTreeKey& at, Random& random) {
  const int side = 1 << random.below(4);
  const float threshold = tree.getOccupancyThresLog();
  const float same =
      random.chance(0.3) ? stepped(threshold, random.between(-2, 2)) : static_cast<float>(random.uniform(-2.0, 3.5));
  const bool alike = random.chance(0.6);  // whether all leaves are equal; OctoMap can then prune the cube to one leaf
  for (int i = 0; i < side * side * side; ++i) {
    const octomap::OcTreeKey key(static_cast<octomap::key_type>((at[0] & -side) + i % side),
                                 static_cast<octomap::key_type>((at[1] & -side) + i / side % side),
                                 static_cast<octomap::key_type>((at[2] & -side) + i / side / side));
    if (i == 0 || alike || random.chance(0.7)) {  // at least one leaf, because OctoMap fails for an empty tree
      tree.setNodeValue(key, alike ? same : static_cast<float>(random.uniform(-2.0, 3.5)), true);
    }
  }
}

template <class Tree>
WrittenMap randomMapAs(Random& random, bool binary, double occupied_from) {
  Tree tree(random.logUniform(0.01, 1.0));
  tree.setOccupancyThres(occupied_from);
  const int spread = 1 << random.between(3, 16);
  const auto key = [&] { return static_cast<octomap::key_type>(32768 - spread / 2 + random.below(spread)); };
  for (int clusters = random.between(1, 20); clusters > 0; --clusters) addCluster(tree, {key(), key(), key()}, random);
  tree.updateInnerOccupancy();
  if (random.chance(0.3)) tree.toMaxLikelihood();
  if (random.chance(0.5)) tree.prune();
  const OctomapFormat format{tree.getTreeType(), binary, tree.getResolution()};
  std::ostringstream out;
  if (binary) {
    tree.writeBinaryData(out);  // not writeBinary(), because it prints a message
    const std::string lines =
        "id " + format.id + "\nsize " + std::to_string(tree.size()) + "\nres " + text(format.resolution) + "\n";
    return {format, out.str(), btHeader(lines) + out.str()};
  }
  tree.write(out);
  const std::size_t header = out.str().find("\ndata\n") + 6;
  return {format, out.str().substr(header), out.str()};
}

}  // namespace

JudgedMap judged(const OctomapFormat& format, const std::string& data, double occupied_from) {
  return format.id == "OcTree" ? judgedAs<octomap::OcTree>(format, data, occupied_from)
                               : judgedAs<octomap::ColorOcTree>(format, data, occupied_from);
}

JudgedMap judgedBinaryFile(const std::string& file) {
  const Silence silence;
  octomap::OcTree tree(0.1);
  std::istringstream in(file);
  if (!tree.readBinary(in)) throw std::runtime_error("OctoMap cannot read the file");
  return leavesOf(tree);
}

double secondsOfReadBinary(const std::string& file) {
  const Silence silence;
  octomap::OcTree tree(0.1);
  std::istringstream in(file);
  const auto begin = std::chrono::steady_clock::now();
  tree.readBinary(in);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

WrittenMap randomMap(Random& random, const std::string& id, bool binary, double occupied_from) {
  return id == "OcTree" ? randomMapAs<octomap::OcTree>(random, binary, occupied_from)
                        : randomMapAs<octomap::ColorOcTree>(random, binary, occupied_from);
}

}  // namespace test
}  // namespace hgrid
