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

/// Positions of one level, to be tested among themselves or against all of another level.
struct SearchTask {
  const kernels::Level* asking;
  const kernels::Level* asked;  // null: among themselves
  std::uint32_t begin, end;
  std::size_t thread = 0, first = 0, found = 0;  // its pairs: so many from the first on in that thread's part
  std::size_t to = 0;                            // where they go
};

/// What a search for pairs works with.
struct SearchBuffers {
  std::vector<SearchTask> tasks;
  std::vector<std::vector<ProxyPair>> parts;  // per thread; room for all pairs in each, since any may do all tasks
  std::vector<std::size_t> used;              // of each part
};

/// What an HGrid holds. Boxes stand in layers by how they behave, each sorted on its own:
///
///   fixed    said to be so; no pairs among themselves
///   resting  did not move for a while; their pairs among themselves and with fixed ones are kept
///   moving   sorted anew whenever one of them moves
///   loose    came or moved one by one; few, until they are sorted with the moving
///
/// Every change allocates all that it needs before it changes a layer. So a change whose allocation fails throws, and
/// the grid holds what it held before.
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
  /// Allocates what takeOut() of the box, if it is stored, and putLoose() need. They allocate nothing then.
  void reserveLoose(ProxyId id);
  /// Takes a box out of its layer; `layer_of` is then kAbsent.
  void takeOut(ProxyId id);
  /// Takes in a box that stands in no layer.
  void putLoose(ProxyId id);
  /// The boxes of these ids, and no others, are stored afterwards.
  void replace(const std::vector<ProxyId>& ids, const std::vector<Aabb>& given);
  /// Sorts all boxes into fixed and resting. If an allocation fails, the layers are as they were.
  /// @param others  the layers do not hold exactly the stored boxes, or not in the right one of the two layers
  void sortAll(bool others = false);
  /// Sorts anew the boxes that moved (`moved`, whose boxes are written already), with those that moved lately. If an
  /// allocation fails, the layers are as they were.
  void sortMoved();
  /// Restores `boxes`, `layer_of` and `stored` from the layers, which still hold what was there before.
  void restoreFromLayers();
  void reserveLayer(LayerNumber layer, std::size_t count);
  void sortLayer(LayerNumber layer);
  void locate(LayerNumber layer);
  /// By id, in its layer. Kept in the array that the resting are sorted to; when they are, so are all layers.
  std::vector<std::uint32_t>& positions() { return layers[kResting].spare(); }
  /// Pairs of what rests, so that they need not be looked for each time.
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
  bool fixed_astray = false;    // some of the loose and moving are fixed: they came or moved one by one
  bool moving_changed = false;  // some of the moving were taken out, and stand there as withdrawn
  std::size_t stored = 0;
  std::size_t withdrawn = 0;   // positions that are empty, in any layer
  double waste = 0.0;          // boxes sorted with the moving although they rested, summed up
  std::vector<ProxyId> moved;  // scratch
  SortScratch scratch;
  std::unique_ptr<Workers> workers = std::make_unique<Workers>(1);

  std::vector<ProxyPair> kept;    // pairs of resting boxes with resting and fixed ones
  std::size_t kept_overlaps = 0;  // overlapping pairs that the search for them looked at
  bool kept_valid = false;
  bool kept_dirty = false;  // some of their boxes are in these layers no more
  mutable std::atomic<bool> pairs_wanted{false};

  // Search for pairs; pair_search.cpp. Threads and their buffers serve one search at a time; a second one that runs
  // beside it does without.
  /// Fills `kept`. It stays invalid and empty if there are more pairs than the bound.
  void findKept();
  /// @returns whether all pairs were found. If not, what stands in `pairs` means nothing.
  bool findPairs(std::vector<ProxyPair>& pairs, const PairBound& up_to) const;
  /// Collects pairs in the order that PairBound says, until the bound is reached. @returns whether these are all pairs
  bool collectPairs(std::vector<ProxyPair>& pairs) const;
  mutable std::mutex search_mutex;
  mutable SearchBuffers buffers;
};

}  // namespace hgrid
