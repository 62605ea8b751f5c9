// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// A compact copy of a snapshot, from which the snapshot can be made again. Immutable.
///
/// Poses and pairs are stored in blocks of a few bodies. A record shares the blocks that are the same in the record
/// before it.
class SnapshotRecord {
 public:
  /// @param previous  the record to share with; may be null
  SnapshotRecord(const Snapshot& snapshot, const SnapshotRecord* previous);

  /// Makes the snapshot again. It has no events, and its broad phase stores the boxes without their margins. All
  /// queries and explanations give the same results as with the original snapshot.
  /// @param bytes  receives the memory [bytes] of the snapshot
  std::shared_ptr<const Snapshot> restore(std::size_t& bytes) const;

  /// Returns the memory [bytes] of what this record does not share with `other`, which may be null. Does not count the
  /// structure and the cells of maps.
  std::size_t bytesBeside(const SnapshotRecord* other) const;

  const std::shared_ptr<const Structure>& structure() const { return structure_; }
  const std::vector<std::shared_ptr<const MapCells>>& cells() const { return cells_; }

 private:
  struct Restored;

  /// A BodyPose without padding and without the constant last row of its matrix.
  struct PackedPose {
    std::array<double, 12> world_from_body;  // the first three rows of the matrix, column by column
    std::array<double, 3> age_reach_growth;
    Time stamp;
    std::uint32_t cohort;
    Freshness state;
  };
  /// What the sources of a snapshot lack. It rarely changes.
  struct Lacks {
    std::vector<SourceGap> gaps;
    std::vector<std::uint32_t> doubtful;
    std::vector<std::string> incomplete, reasons;
    std::uint32_t reasons_total;
  };
  using PoseBlock = std::shared_ptr<const std::vector<PackedPose>>;
  using PairBlock = std::shared_ptr<const std::vector<NearPair>>;  // null: no pair

  static PackedPose packed(const BodyPose& pose);
  static BodyPose unpacked(const PackedPose& packed);
  static bool isSame(const PackedPose& a, const PackedPose& b);
  static bool isSame(const Lacks& a, const Lacks& b);
  static std::size_t bytesOf(const Lacks& lacks);
  void storePoses(const Snapshot& snapshot, const SnapshotRecord* previous);
  void storePairs(const Snapshot& snapshot, const SnapshotRecord* previous);
  void storeLacks(const Snapshot& snapshot, const SnapshotRecord* previous);
  void makeBoxes(Restored& made) const;

  std::shared_ptr<const Structure> structure_;
  std::vector<std::shared_ptr<const MapCells>> cells_;
  std::vector<PoseBlock> poses_;
  std::vector<PairBlock> pairs_;  // by the block of the first body of the pair
  std::shared_ptr<const Lacks> lacks_;
  std::shared_ptr<const BodyRooms> rooms_;  // null: there are no rooms
  Time stamp_;
  std::uint64_t sequence_, epoch_, commit_, pairs_found_, last_event_;
  Eigen::Vector3d origin_;
  bool search_cut_, report_unmapped_;
};

}  // namespace hgrid
