// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/maps/map.h"
#include "hgrid_proximity/adapters/octomap.h"

namespace hgrid {
namespace bench {

/// Whether a ball touches a leaf; all leaves that it touches; the first leaf along a segment.
enum class MapQuestion { touches, overlapping, segment };
constexpr MapQuestion kMapQuestions[] = {MapQuestion::touches, MapQuestion::overlapping, MapQuestion::segment};

const char* name(MapQuestion question);

/// Something that knows a map and answers questions [m] about its occupied leaves.
class MapPeer {
 public:
  virtual ~MapPeer() = default;

  virtual bool answers(MapQuestion question) const = 0;
  // Only called for questions that are answered; `found` is replaced, in any order.
  virtual bool touches(const Sphere&) { return false; }
  virtual void overlapping(const Sphere&, std::vector<Voxel>&) {}
  /// The leaf, or any cell of it.
  virtual std::optional<Voxel> firstAlong(const Segment&) { return std::nullopt; }

  /// All occupied leaves, in any order.
  virtual std::vector<Voxel> leaves() = 0;
  /// [byte] What the peer itself says that it holds; 0: it does not, and what it has allocated is counted.
  virtual std::size_t bytes() const { return 0; }
};

/// A peer by name, and the ways in which it can be had; those it does not have are empty.
struct MapPeerKind {
  using Make = std::function<std::unique_ptr<MapPeer>(const Map&)>;

  std::string name;
  std::size_t most;  ///< leaves; with more, loading takes far too long
  Make from_file;    ///< read and ready for questions
  Make from_leaves;
};

/// The peers that this program was built with, ours first.
const std::vector<MapPeerKind>& mapPeers();

/// Our reader, for any file.
Octomap readMap(const std::string& file);

// One or two per peer; those of libraries that were not found are declared only.
std::unique_ptr<MapPeer> readStaticGrid(const Map& map);
std::unique_ptr<MapPeer> makeStaticGrid(const Map& map);
std::unique_ptr<MapPeer> readOcTree(const Map& map);
std::unique_ptr<MapPeer> readFclOcTree(const Map& map);
std::unique_ptr<MapPeer> makeFclLeafBoxes(const Map& map);

}  // namespace bench
}  // namespace hgrid
