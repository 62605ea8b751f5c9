// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "broadphase/hgrid/layer.h"
#include "hgrid_proximity/broadphase/hgrid.h"

namespace hgrid {

/// A part of a search for pairs. Either some positions of one level, tested among themselves or against all of another
/// level, or some regions of a layer, tested among themselves and the later ones, or against all of another layer.
struct SearchTask {
  const kernels::Level* asking;
  const kernels::Level* asked;   // null: the positions are tested among themselves
  std::uint32_t begin, end;      // positions, or regions
  const Layer* layer = nullptr;  // of the regions; null: positions
  const Layer* other = nullptr;  // null: the regions are tested among themselves and with the later ones
  std::size_t boxes = 0;
  std::size_t thread = 0, first = 0, found = 0;  // its pairs: `found` pairs from `first` on, in the part of that thread
  std::size_t to = 0;                            // index of its first pair in the result
};

/// Copies of some boxes of a level, which can ask another level.
struct GatheredBoxes {
  std::vector<std::uint32_t> levels;  // that a level reaches
  std::vector<std::uint32_t> positions;
  std::vector<float> bounds;
  std::vector<std::uint32_t> ids;
};

/// Buffers of a search for pairs.
struct SearchBuffers {
  std::vector<SearchTask> tasks;
  std::vector<std::vector<ProxyPair>> parts;  // per thread, each with room for all pairs: one thread may do all tasks
  std::vector<std::size_t> used;              // pairs in each part
  std::vector<GatheredBoxes> gathered;        // per thread
};

/// The implementation of HGrid. Each box is in one of four layers, which are sorted separately:
///
///   fixed    declared by setFixed(); no pairs among themselves
///   resting  did not move for a while; the grid keeps their pairs among themselves and with fixed boxes
///   moving   sorted again whenever one of them moves
///   loose    inserted or moved by a call for one box; there are few of them, because they soon join the moving boxes
///
/// Every change allocates all memory that it needs before it changes a layer. If the allocation fails, the change
/// throws, and the grid holds the boxes that it held before.
struct HGrid::Engine {
  enum LayerNumber : std::uint8_t { kFixed, kResting, kMoving, kLoose, kLayers, kAbsent };

  explicit Engine(double finest);

  bool isFixed(ProxyId id) const { return id < fixed.size() && fixed[id]; }
  bool isStored(ProxyId id) const { return id < layer_of.size() && layer_of[id] != kAbsent; }
  void requireStored(ProxyId id) const;
  void requireValid(const std::vector<ProxyId>& ids, const std::vector<Aabb>& given);
  Machine machine() { return {&kernels::of(isa), workers.get(), &scratch}; }

  // Changes; engine.cpp.
  /// Makes room for a box of this id.
  void grow(ProxyId id);
  /// Allocates what takeOut() (if the box is stored) and putLoose() need, so that they allocate nothing.
  void reserveLoose(ProxyId id);
  /// Takes a box out of its layer; `layer_of` is then kAbsent.
  void takeOut(ProxyId id);
  /// Adds a box that is in no layer to the loose ones.
  void putLoose(ProxyId id);
  /// Stores these boxes and no others.
  void replace(const std::vector<ProxyId>& ids, const std::vector<Aabb>& given);
  /// Sorts all boxes into fixed and resting. If an allocation fails, the layers are as they were.
  /// @param others  true if the layers do not hold exactly the stored boxes, or hold some in the wrong one of the two
  void sortAll(bool others = false);
  /// Sorts the boxes that moved (`moved`; the caller has written them to `boxes`) with those that moved recently. If an
  /// allocation fails, the layers are as they were.
  void sortMoved();
  /// Restores `boxes`, `layer_of` and `stored` from the layers, which still hold what was there before.
  void restoreFromLayers();
  void reserveLayer(LayerNumber layer, std::size_t count);
  void sortLayer(LayerNumber layer);
  void locate(LayerNumber layer);
  /// Position of each box in its layer, by id. Shares memory with the sorting of the resting layer: whenever that layer
  /// is sorted, all layers are, and all positions become invalid.
  std::vector<std::uint32_t>& positions() { return layers[kResting].spare(); }
  /// Updates `kept`, so that searches need not find the pairs of resting boxes again.
  void keepPairs();

  std::size_t movingWithLoose() const;
  bool settlesLoose(std::size_t loose, std::size_t withdrawn_then, std::size_t stored_then) const;
  bool settlesAll(std::size_t moving, std::size_t withdrawn_then, std::size_t stored_then) const;
  void joinLoose();
  void settleLoose();

  double finest_edge;
  Isa isa = bestIsa();
  OverlapFilter filter;
  PairBound bound;
  std::vector<Aabb> boxes;            // by id
  std::vector<LayerNumber> layer_of;  // by id
  std::vector<bool> fixed;            // by id; may be shorter
  std::array<Layer, kLayers> layers;
  std::array<std::vector<ProxyId>, kLayers> members;  // moving and loose: ids
  std::array<bool, kLayers> located{};                // layers whose boxes have their positions in positions()
  bool fixed_astray = false;                          // some loose or moving boxes are fixed
  bool moving_changed = false;                        // some boxes of the moving layer are withdrawn
  std::size_t stored = 0;
  std::size_t withdrawn = 0;   // withdrawn positions in all layers
  double waste = 0.0;          // sum over sorts of the boxes that were sorted although they did not move
  std::vector<ProxyId> moved;  // scratch
  SortScratch scratch;
  std::unique_ptr<Workers> workers = std::make_unique<Workers>(1);

  std::vector<ProxyPair> kept;    // pairs of resting boxes with resting and fixed ones
  std::size_t kept_overlaps = 0;  // overlapping pairs that the search for `kept` looked at
  bool kept_valid = false;
  bool kept_dirty = false;  // some of their boxes have left these layers
  mutable std::atomic<bool> pairs_wanted{false};

  // Search for pairs; pair_search.cpp. One search at a time uses the threads and the buffers; a concurrent one uses
  // neither.
  /// Fills `kept`. It stays invalid and empty if there are more pairs than the bound.
  void findKept();
  /// @returns whether it found all pairs. If not, the contents of `pairs` are meaningless.
  bool findPairs(std::vector<ProxyPair>& pairs, const PairBound& up_to) const;
  /// Collects pairs in the order that PairBound says, until the bound is reached. @returns whether these are all pairs
  bool collectPairs(std::vector<ProxyPair>& pairs) const;
  mutable std::mutex search_mutex;
  mutable SearchBuffers buffers;
};

}  // namespace hgrid
