// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace hgrid {

/// What is stored: a text for each key. A key is a kind and a name, as in "obstacle obstacle/box".
using StateItems = std::map<std::string, std::string>;

/// One change of the stored items.
struct StateEdit {
  enum class Kind {
    set,         ///< the item `key` becomes `text`
    erase,       ///< the item `key` is removed
    erase_kind,  ///< all items whose key begins with `key` are removed
  };
  Kind kind = Kind::set;
  std::string key;
  std::string text;
};

/// Applies edits in their order.
void applyEdits(const std::vector<StateEdit>& edits, StateItems& items);

}  // namespace hgrid
