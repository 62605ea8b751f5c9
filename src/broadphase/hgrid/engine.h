// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "broadphase/hgrid/layer.h"
#include "broadphase/hgrid/loose_boxes.h"
#include "broadphase/hgrid/region_search.h"
#include "broadphase/hgrid/search_tasks.h"
#include "hgrid_proximity/broadphase/hgrid.h"

namespace hgrid {

/// Buffers of a search for pairs.
struct SearchBuffers {
  std::vector<SearchTask> tasks;
  std::vector<std::vector<ProxyPair>> parts;  // pairs per thread; each has room for all pairs: one may do all tasks
  std::vector<std::size_t> used;              // number of pairs in each part
  std::vector<GatheredBoxes> gathered;        // per thread: the copied boxes
  std::vector<ProxyPair> found;               // the pairs of a whole search, if Engine::keep_found asked for them
  std::size_t found_overlaps = 0;             // overlapping pairs that this search looked at
  bool found_valid = false;                   // whether `found` has the pairs of all boxes of the layers
};

/// The implementation of HGrid. Each box is in one of four layers, which are sorted separately:
///
///   fixed    boxes that setFixed() names; two fixed boxes never form a pair
///   resting  boxes that did not move for a while; the grid keeps their pairs with resting and fixed boxes
///   moving   boxes that moved recently; all of them are sorted again when one of them moves
///   loose    boxes that were inserted or moved one at a time. They are in a hash table (LooseBoxes), which queries
///            search directly. The first search for pairs after a change sorts them into this layer, and later they
///            join the moving boxes. If other boxes move each time, these are the boxes that moved the last time, in
///            the layer only. Most of them then return to their positions in the resting layer
///
/// "Withdrawn" boxes are still in the arrays of a layer, but searches no longer find them.
///
/// Every change allocates all memory that it needs before it changes a layer. If the allocation fails, the change
/// throws, and the grid holds the boxes that it held before.
struct HGrid::Engine {
  /// If a search for pairs has sorted more loose boxes, they join the moving boxes before the next change.
  static constexpr std::size_t kMostLoose = 64;
  /// Sorting takes as long per box as about so many tests of a box in the table.
  static constexpr std::size_t kSortingWork = 12;
  enum LayerNumber : std::uint8_t { kFixed, kResting, kMoving, kLoose, kLayers, kAbsent };

  explicit Engine(double finest);

  bool isFixed(ProxyId id) const { return id < fixed.size() && fixed[id]; }
  bool isStored(ProxyId id) const { return id < layer_of.size() && layer_of[id] != kAbsent; }
  void requireStored(ProxyId id) const {
    if (!isStored(id)) throwNotStored(id);
  }
  [[noreturn]] static void throwNotStored(ProxyId id);
  void requireValid(const std::vector<ProxyId>& ids, const std::vector<Aabb>& given);
  Machine machine() { return {loops, workers.get(), &scratch}; }

  // Functions that change the stored boxes (engine.cpp).
  /// Makes room for a box with this id.
  void grow(ProxyId id);
  /// Prepares for putLoose() with this box and, if it is stored, for takeOut(): they then allocate nothing. If the
  /// loose boxes have no room for it, or are too many, they join the other layers. Changes no stored box.
  void reserveLoose(ProxyId id, const Aabb& box);
  /// Removes a box from its layer and sets its `layer_of` to kAbsent.
  void takeOut(ProxyId id);
  /// Adds a box that is in no layer to the loose boxes.
  void putLoose(ProxyId id);
  /// Stores exactly these boxes, given[i] under ids[i], and removes all others.
  void replace(const std::vector<ProxyId>& ids, const std::vector<Aabb>& given);
  /// Sorts all boxes into the fixed and the resting layer. If an allocation fails, the layers are unchanged.
  /// @param others  true if the layers may hold boxes that are not stored, or a box may be in the wrong layer
  void sortAll(bool others = false);
  /// Sorts the boxes whose ids are in `moved`, together with the boxes that moved recently. The caller has already
  /// written the new coordinates to `boxes`. If an allocation fails, the layers are unchanged.
  void sortMoved();
  /// Works like sortMoved() if other boxes move each time: sorts the boxes in `moved` into the loose layer. The boxes
  /// that were there return to the resting layer, or join the moving layer if their old positions cannot hold them.
  /// Then the next search only looks for the pairs of the loose boxes, because the last search has found all others.
  /// @returns false if the last search did not keep its pairs; then nothing has changed
  bool sortOthers(std::size_t started);
  /// Puts a box back into the resting layer, if it was withdrawn there and still fits its position.
  /// @returns whether it did
  bool putBack(ProxyId id);
  /// Restores `boxes`, `layer_of` and `stored` from the layers, which still hold the boxes from before the change.
  void restoreFromLayers();
  void reserveLayer(LayerNumber layer, std::size_t count);
  void sortLayer(LayerNumber layer);
  /// Writes the positions of the layer's boxes to positions().
  void locate(LayerNumber layer);
  /// Returns the position of each box in its layer, by id. The positions in a layer are valid only if `located` says
  /// so. A sort of the resting layer overwrites this array. That is no loss: then all layers are sorted, so all
  /// positions change.
  std::vector<std::uint32_t>& positions() { return layers[kResting].spare(); }
  /// Updates `kept`, so that the next search need not find the pairs of resting boxes again.
  void keepPairs();
  /// Takes `kept` from the last search, if that search kept its pairs and they do not exceed the bound.
  /// @returns whether it did
  bool keepFound();
  /// Forgets all pairs that were kept.
  void dropKept();
  /// Returns whether both boxes of a pair are in the layers of `kept`.
  bool isKept(const ProxyPair& pair) const {
    const LayerNumber last = kept_moving ? kMoving : kResting;
    return std::max(layer_of[pair.first], layer_of[pair.second]) <= last;  // one branch instead of two
  }
  /// Returns whether most boxes that moved the last time do not move now. Samples the boxes in `moved` for the next
  /// call.
  bool movesOthers();

  /// Returns the number of moving and loose boxes, if no loose box is in the table.
  std::size_t movingWithLoose() const;
  /// Whether the loose boxes are in the table, and not in members[kLoose].
  bool isHashed() const { return singles.size() != 0; }
  bool isSingle(ProxyId id) const { return layer_of[id] == kLoose && isHashed(); }
  /// Moves a box that is in the table and may stay there. @returns whether it did
  bool moveSingle(ProxyId id, const Aabb& box);
  /// Whether the boxes of the table should join the moving boxes: a search for pairs has sorted many of them, or
  /// queries spent more time in the table than sorting takes.
  bool singlesSettle() const {
    return (loose_sorted && singles.size() >= kMostLoose) ||
           singles.excess() > kSortingWork * (members[kMoving].size() + singles.size());
  }
  void singlesChanged();
  /// Turns the loose boxes into moving boxes, or sorts all boxes if these are too many. If an allocation fails, the
  /// layers are unchanged.
  void settleLoose();
  void joinLoose();
  void emptyLooseLayer();
  /// Moves the loose boxes from the table to their layer. If an allocation fails, they stay in the table.
  void unhash();
  /// Sorts the boxes of the table into the loose layer, where they stay in the table, too. Several threads may call it.
  void sortLoose() const;

  double finest_edge;
  Isa isa = bestIsa();
  const kernels::Kernels* loops = &kernels::of(isa);  // the inner loops for `isa`
  OverlapFilter filter;
  PairBound bound;
  std::vector<Aabb> boxes;                    // the box of each id
  std::vector<LayerNumber> layer_of;          // the layer of each id; kAbsent if there is no box with this id
  std::vector<bool> fixed;                    // for each id: whether it is fixed; ids beyond the end are not fixed
  mutable std::array<Layer, kLayers> layers;  // sortLoose() changes the loose layer
  std::array<std::vector<ProxyId>, kLayers> members;  // ids of the moving boxes, and of the loose boxes in no table
  LooseBoxes singles;                                 // the loose boxes; positions() has their places
  mutable std::atomic<bool> loose_sorted{true};       // whether the loose layer has the boxes of the table
  mutable std::mutex loose_mutex;                     // protects the sorting by sortLoose()
  mutable SortScratch loose_scratch;                  // used by sortLoose() only
  std::array<bool, kLayers> located{};                // whether positions() is valid for the boxes of a layer
  bool fixed_astray = false;                          // whether some fixed boxes are in the loose or moving layer
  bool moving_changed = false;                        // whether some boxes of the moving layer were withdrawn
  std::size_t stored = 0;                             // number of stored boxes
  std::size_t withdrawn = 0;                          // number of withdrawn boxes in all layers
  double waste = 0.0;          // how many boxes were sorted although they did not move, summed since the last sortAll()
  std::vector<ProxyId> moved;  // ids of the boxes that sortMoved() sorts
  std::array<ProxyId, 32> moved_before{};  // some of the boxes that sortMoved() sorted the last time
  std::size_t moved_before_count = 0;      // number of them
  SortScratch scratch;
  std::unique_ptr<Workers> workers = std::make_unique<Workers>(1);

  std::vector<ProxyPair> kept;    // pairs of resting boxes with resting and fixed boxes; see kept_moving
  bool kept_moving = false;       // whether `kept` also has the pairs of moving boxes with all but loose boxes; only
                                  // true if kept_dirty is
  std::size_t kept_overlaps = 0;  // overlapping pairs that the search for `kept` looked at
  bool kept_valid = false;        // whether `kept` can be used
  bool kept_dirty = false;        // whether some boxes of `kept` are not in its layers anymore
  bool keep_found = false;        // whether a search for all pairs copies them, because they will be needed as `kept`
  mutable std::atomic<bool> pairs_wanted{false};  // whether there was a search for pairs; if not, `kept` is not needed

  // Search for pairs (pair_search.cpp, pair_collection.cpp). Only one search at a time uses the threads and the shared
  // buffers. If another search runs at the same time, it uses one thread and buffers of its own.
  /// Finds the pairs for `kept`. If they exceed the bound, `kept` is empty and kept_valid is false.
  void findKept();
  /// Finds all pairs if they do not exceed the bound. @returns whether it found all pairs; if not, `pairs` is
  /// meaningless
  bool findPairs(std::vector<ProxyPair>& pairs, const PairBound& up_to) const;
  /// Collects pairs in the order that PairBound specifies, up to the bound. @returns whether these are all pairs
  bool collectPairs(std::vector<ProxyPair>& pairs) const;
  mutable std::mutex search_mutex;
  mutable SearchBuffers buffers;
};

}  // namespace hgrid
