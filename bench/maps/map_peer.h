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

/// Kinds of questions:
/// - touches: whether a sphere touches any leaf
/// - small: whether a small sphere touches any leaf
/// - overlapping: which leaves a sphere touches
/// - segment: which leaf comes first along a segment
enum class MapQuestion { touches, small, overlapping, segment };
constexpr MapQuestion kMapQuestions[] = {MapQuestion::touches, MapQuestion::small, MapQuestion::overlapping,
                                         MapQuestion::segment};

const char* name(MapQuestion question);

/// A map in the benchmark. It answers questions about its occupied leaves. Coordinates [m] are in the map's frame.
class MapPeer {
 public:
  virtual ~MapPeer() = default;

  virtual bool answers(MapQuestion question) const = 0;
  // The next three functions are only called for kinds of questions that answers() accepts.

  virtual bool touches(const Sphere&) { return false; }
  /// Replaces the list with all leaves that the sphere touches, in any order.
  virtual void overlapping(const Sphere&, std::vector<Voxel>&) {}
  /// Returns the first leaf along the segment, or any cell in that leaf.
  virtual std::optional<Voxel> firstAlong(const Segment&) { return std::nullopt; }

  /// Returns all occupied leaves, in any order.
  virtual std::vector<Voxel> leaves() = 0;
  /// Returns how many bytes the peer says that it holds. 0: the peer does not say it; its allocated bytes count
  /// instead.
  virtual std::size_t bytes() const { return 0; }
};

/// A kind of peer and the functions that create the peer. A function is empty if the peer cannot be created in this
/// way.
struct MapPeerKind {
  using Make = std::function<std::unique_ptr<MapPeer>(const Map&)>;

  std::string name;
  std::size_t most;  ///< largest number of leaves; with more leaves, loading takes far too long
  Make from_file;    ///< reads the file of the map; afterwards the peer answers questions
  Make from_leaves;  ///< builds the peer from the list of leaves
};

/// Returns the peers that this program was built with, hgrid first.
const std::vector<MapPeerKind>& mapPeers();

/// Reads an OctoMap file with hgrid's reader.
Octomap readMap(const std::string& file);

// One or two factories per peer. If the library of a peer was not found, its factories are declared but not defined.
std::unique_ptr<MapPeer> readStaticGrid(const Map& map);
std::unique_ptr<MapPeer> makeStaticGrid(const Map& map);
std::unique_ptr<MapPeer> readOcTree(const Map& map);
std::unique_ptr<MapPeer> readFclOcTree(const Map& map);
std::unique_ptr<MapPeer> makeFclLeafBoxes(const Map& map);

}  // namespace bench
}  // namespace hgrid
