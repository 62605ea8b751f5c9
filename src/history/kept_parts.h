// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "hgrid_proximity/world/snapshot.h"

namespace hgrid {

/// Counts the bytes of the large parts of past ticks that only these ticks keep alive: structures, bodies, meshes, and
/// the cells of maps. Each part counts once, however many ticks use it. A part that the newest tick uses does not
/// count, because it exists anyway. The bytes of solids and of the matrices of robots are estimates, rather too large
/// than too small.
class KeptParts {
 public:
  using Cells = std::vector<std::shared_ptr<const MapCells>>;

  /// Call this for each tick that is kept from now on, with its parts. The tick must keep the parts alive.
  void use(const std::shared_ptr<const Structure>& structure, const Cells& cells);
  /// Call this for each kept tick that is dropped, with its parts, before the parts are destroyed.
  void release(const std::shared_ptr<const Structure>& structure, const Cells& cells);
  /// Sets the parts of the newest tick.
  void setNewest(const std::shared_ptr<const Structure>& structure, const Cells& cells);

  /// Returns the memory [bytes] of the parts that count.
  std::size_t bytes() const { return bytes_; }

 private:
  struct Part {
    std::size_t bytes = 0;   // [bytes] size of the part
    std::uint32_t uses = 0;  // how many kept structures or ticks use the part
    bool newest = false;     // whether the newest tick uses the part
  };
  template <class Change>
  void edit(const void* key, std::size_t bytes, const Change& change);
  template <class Change>
  void editStructure(const Structure& structure, const Change& change);
  template <class Change>
  void editCells(const Cells& cells, const Change& change);

  std::unordered_map<const void*, Part> parts_;
  std::unordered_map<const Structure*, std::size_t> ticks_of_;  // how many kept ticks have this structure
  std::shared_ptr<const Structure> newest_;
  Cells newest_cells_;
  std::size_t bytes_ = 0;
};

}  // namespace hgrid
