// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "history/snapshot_record.h"

#include <algorithm>
#include <cstring>

#include "hgrid_proximity/broadphase/hgrid.h"
#include "hgrid_proximity/geometry/float_environment.h"

namespace hgrid {
namespace {

constexpr std::size_t kPoseBlock = 8, kPairBlock = 32;  // bodies in a block
constexpr std::size_t kAllocation = 2 * 24;  // [bytes] overhead of a shared vector: control block and allocator

template <class Item>
std::size_t bytesOf(const std::shared_ptr<const std::vector<Item>>& block) {
  return block ? sizeof(*block) + block->capacity() * sizeof(Item) + kAllocation : 0;
}

/// Returns the memory of the blocks that `blocks` does not share with `others`, which may be null.
template <class Block>
std::size_t bytesBeside(const std::vector<Block>& blocks, const std::vector<Block>* others) {
  std::size_t bytes = blocks.capacity() * sizeof(Block);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const bool shared = others != nullptr && i < others->size() && (*others)[i] == blocks[i];
    if (!shared) bytes += bytesOf(blocks[i]);
  }
  return bytes;
}

/// Whether both pairs have the same bits. A comparison of numbers would take 0 and -0 as equal.
bool isSame(const NearPair& a, const NearPair& b) {
  return a.first == b.first && a.second == b.second && std::memcmp(&a.gap, &b.gap, sizeof(a.gap)) == 0 &&
         std::memcmp(&a.margin, &b.margin, sizeof(a.margin)) == 0 && a.since == b.since && a.flags == b.flags;
}

/// Returns block `i` of the previous record, or null if there is none.
template <class Block>
Block blockBefore(const std::vector<Block>* before, std::size_t i) {
  return before != nullptr && i < before->size() ? (*before)[i] : nullptr;
}

bool isSame(const SourceGap& a, const SourceGap& b) {
  if (a.source != b.source || a.bodies != b.bodies || a.sentence != b.sentence) return false;
  if (a.within.has_value() != b.within.has_value()) return false;
  return !a.within || (a.within->center == b.within->center && a.within->radius == b.within->radius);
}

std::size_t bytesOf(const std::vector<std::string>& texts) {
  std::size_t bytes = texts.capacity() * sizeof(std::string);
  for (const std::string& text : texts) bytes += text.capacity();
  return bytes;
}

}  // namespace

struct SnapshotRecord::Restored {
  Restored() { snapshot.broad_phase_ = &grid; }
  Snapshot snapshot;
  HGrid grid;
};

SnapshotRecord::PackedPose SnapshotRecord::packed(const BodyPose& pose) {
  PackedPose packed;
  Eigen::Map<Eigen::Matrix<double, 3, 4>>(packed.world_from_body.data()) = pose.world_from_body.matrix().topRows<3>();
  packed.age_reach_growth = {pose.age, pose.reach, pose.growth};
  packed.stamp = pose.stamp;
  packed.cohort = pose.cohort;
  packed.state = pose.state;
  return packed;
}

BodyPose SnapshotRecord::unpacked(const PackedPose& packed) {
  BodyPose pose;
  pose.world_from_body.matrix().topRows<3>() =
      Eigen::Map<const Eigen::Matrix<double, 3, 4>>(packed.world_from_body.data());
  pose.age = packed.age_reach_growth[0];
  pose.reach = packed.age_reach_growth[1];
  pose.growth = packed.age_reach_growth[2];
  pose.stamp = packed.stamp;
  pose.cohort = packed.cohort;
  pose.state = packed.state;
  return pose;
}

/// Whether both poses have the same bits.
bool SnapshotRecord::isSame(const PackedPose& a, const PackedPose& b) {
  return std::memcmp(a.world_from_body.data(), b.world_from_body.data(), sizeof(a.world_from_body)) == 0 &&
         std::memcmp(a.age_reach_growth.data(), b.age_reach_growth.data(), sizeof(a.age_reach_growth)) == 0 &&
         a.stamp == b.stamp && a.cohort == b.cohort && a.state == b.state;
}

bool SnapshotRecord::isSame(const Lacks& a, const Lacks& b) {
  return a.reasons_total == b.reasons_total && a.doubtful == b.doubtful && a.incomplete == b.incomplete &&
         a.reasons == b.reasons &&
         std::equal(a.gaps.begin(), a.gaps.end(), b.gaps.begin(), b.gaps.end(),
                    [](const SourceGap& one, const SourceGap& other) { return hgrid::isSame(one, other); });
}

std::size_t SnapshotRecord::bytesOf(const Lacks& lacks) {
  std::size_t bytes = sizeof(Lacks) + kAllocation + lacks.doubtful.capacity() * sizeof(std::uint32_t) +
                      hgrid::bytesOf(lacks.incomplete) + hgrid::bytesOf(lacks.reasons) +
                      lacks.gaps.capacity() * sizeof(SourceGap);
  for (const SourceGap& gap : lacks.gaps)
    bytes += gap.source.capacity() + gap.bodies.capacity() + gap.sentence.capacity();
  return bytes;
}

SnapshotRecord::SnapshotRecord(const Snapshot& snapshot, const SnapshotRecord* previous)
    : structure_(snapshot.structure_),
      cells_(snapshot.cells_),
      rooms_(snapshot.rooms_),
      stamp_(snapshot.stamp_),
      sequence_(snapshot.sequence_),
      epoch_(snapshot.epoch_),
      commit_(snapshot.commit_),
      pairs_found_(snapshot.pairs_found_),
      last_event_(snapshot.events_.last),
      origin_(snapshot.origin_),
      search_cut_(snapshot.search_cut_),
      report_unmapped_(snapshot.report_unmapped_) {
  storePoses(snapshot, previous);
  storePairs(snapshot, previous);
  storeLacks(snapshot, previous);
}

void SnapshotRecord::storePoses(const Snapshot& snapshot, const SnapshotRecord* previous) {
  const std::vector<BodyPose>& poses = snapshot.poses_;
  poses_.reserve((poses.size() + kPoseBlock - 1) / kPoseBlock);
  std::vector<PackedPose> block;
  block.reserve(kPoseBlock);
  for (std::size_t begin = 0; begin < poses.size(); begin += kPoseBlock) {
    block.clear();
    for (std::size_t i = begin; i < std::min(begin + kPoseBlock, poses.size()); ++i) block.push_back(packed(poses[i]));
    PoseBlock before = blockBefore(previous != nullptr ? &previous->poses_ : nullptr, poses_.size());
    const bool same = before && std::equal(block.begin(), block.end(), before->begin(), before->end(),
                                           [](const auto& a, const auto& b) { return isSame(a, b); });
    poses_.push_back(same ? std::move(before) : std::make_shared<const std::vector<PackedPose>>(block));
  }
}

void SnapshotRecord::storePairs(const Snapshot& snapshot, const SnapshotRecord* previous) {
  const std::size_t blocks = (snapshot.poses_.size() + kPairBlock - 1) / kPairBlock;
  pairs_.reserve(blocks);
  auto begin = snapshot.pairs_.begin();
  for (std::size_t i = 0; i < blocks; ++i) {
    auto end = begin;
    while (end != snapshot.pairs_.end() && end->first < (i + 1) * kPairBlock) ++end;
    PairBlock before = blockBefore(previous != nullptr ? &previous->pairs_ : nullptr, i);
    const bool same = before && std::equal(begin, end, before->begin(), before->end(),
                                           [](const auto& a, const auto& b) { return hgrid::isSame(a, b); });
    if (begin == end) {
      pairs_.push_back(nullptr);
    } else {
      pairs_.push_back(same ? std::move(before) : std::make_shared<const std::vector<NearPair>>(begin, end));
    }
    begin = end;
  }
}

void SnapshotRecord::storeLacks(const Snapshot& snapshot, const SnapshotRecord* previous) {
  Lacks lacks{snapshot.gaps_, snapshot.doubtful_, snapshot.incomplete_, snapshot.reasons_, snapshot.reasons_total_};
  if (previous != nullptr && isSame(lacks, *previous->lacks_)) {
    lacks_ = previous->lacks_;
  } else {
    lacks_ = std::make_shared<const Lacks>(std::move(lacks));
  }
}

std::size_t SnapshotRecord::bytesBeside(const SnapshotRecord* other) const {
  std::size_t bytes = sizeof(*this) + kAllocation + cells_.capacity() * sizeof(cells_[0]);
  bytes += hgrid::bytesBeside(poses_, other != nullptr ? &other->poses_ : nullptr);
  bytes += hgrid::bytesBeside(pairs_, other != nullptr ? &other->pairs_ : nullptr);
  if (rooms_ && !(other != nullptr && other->rooms_ == rooms_)) bytes += rooms_->bytes() + kAllocation;
  return other != nullptr && other->lacks_ == lacks_ ? bytes : bytes + bytesOf(*lacks_);
}

/// Computes the boxes of all placed bodies in the same way as Scene, and stores them in the grid.
void SnapshotRecord::makeBoxes(Restored& made) const {
  Snapshot& snapshot = made.snapshot;
  std::vector<ProxyId> ids;
  std::vector<Aabb> placed;
  for (std::uint32_t body = 0; body < snapshot.poses_.size(); ++body) {
    const BodyPose& pose = snapshot.poses_[body];
    const bool is_placed = pose.state != Freshness::unplaced;
    for (const BodyShape& shape : structure_->bodies[body].shapes) {
      const Pose world_from_shape = pose.world_from_body * shape.body_from_shape;
      const bool has_box = is_placed && shape.shape.kind() != ShapeKind::plane;
      snapshot.boxes_.push_back(has_box ? boxOf(shape.shape, world_from_shape, shape.padding, origin_) : Aabb{});
      if (!has_box) continue;
      ids.push_back(static_cast<ProxyId>(snapshot.boxes_.size() - 1));
      placed.push_back(snapshot.boxes_.back());
    }
  }
  made.grid = HGrid(GridScale::fitting(placed));
  made.grid.update(ids, placed);
}

std::shared_ptr<const Snapshot> SnapshotRecord::restore(std::size_t& bytes) const {
  const DefaultFloatEnvironment environment;
  const auto made = std::make_shared<Restored>();
  Snapshot& snapshot = made->snapshot;
  snapshot.structure_ = structure_;
  snapshot.stamp_ = stamp_;
  snapshot.sequence_ = sequence_;
  snapshot.epoch_ = epoch_;
  snapshot.commit_ = commit_;
  snapshot.origin_ = origin_;
  snapshot.poses_.reserve(structure_->bodies.size());
  for (const PoseBlock& block : poses_) {
    for (const PackedPose& pose : *block) snapshot.poses_.push_back(unpacked(pose));
  }
  snapshot.boxes_.reserve(structure_->body_of_proxy.size());
  makeBoxes(*made);
  snapshot.fillHalfSpaces();
  for (std::uint32_t body = 0; body < snapshot.poses_.size(); ++body) snapshot.addToSummary(body);
  snapshot.cells_ = cells_;
  snapshot.rooms_ = rooms_;
  for (const PairBlock& block : pairs_) {
    if (block) snapshot.pairs_.insert(snapshot.pairs_.end(), block->begin(), block->end());
  }
  snapshot.pairs_found_ = pairs_found_;
  snapshot.search_cut_ = search_cut_;
  snapshot.events_.last = last_event_;
  snapshot.gaps_ = lacks_->gaps;
  snapshot.doubtful_ = lacks_->doubtful;
  snapshot.incomplete_ = lacks_->incomplete;
  snapshot.reasons_ = lacks_->reasons;
  snapshot.reasons_total_ = lacks_->reasons_total;
  snapshot.report_unmapped_ = report_unmapped_;
  bytes = sizeof(Restored) + snapshot.poses_.capacity() * sizeof(BodyPose) + snapshot.boxes_.capacity() * sizeof(Aabb) +
          snapshot.half_spaces_.capacity() * sizeof(HalfSpace) + snapshot.watched_.capacity() * sizeof(std::uint32_t) +
          snapshot.pairs_.capacity() * sizeof(NearPair) + made->grid.bytes() + bytesOf(*lacks_);
  return {made, &snapshot};
}

}  // namespace hgrid
