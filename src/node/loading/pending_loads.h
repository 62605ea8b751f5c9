// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace hgrid {

/// A list of loads that are still to be put into the world, in the order in which they were added. Only one thread may
/// use it.
template <class Load>
class PendingLoads {
 public:
  bool empty() const { return loads_.empty(); }
  /// Returns the load of this name, or null.
  const Load* find(const std::string& name) const {
    const auto has_name = [&](const Named& named) { return named.name == name; };
    const auto found = std::find_if(loads_.begin(), loads_.end(), has_name);
    return found == loads_.end() ? nullptr : &found->load;
  }

  /// Adds a load. Removes an earlier load of the same name.
  void put(const std::string& name, Load load) {
    loads_.reserve(loads_.size() + 1);
    remove(name);
    loads_.push_back({name, std::move(load)});
  }
  /// Removes the load of this name, if there is one.
  void remove(const std::string& name) {
    const auto has_name = [&](const Named& named) { return named.name == name; };
    loads_.erase(std::remove_if(loads_.begin(), loads_.end(), has_name), loads_.end());
  }
  void clear() { loads_.clear(); }

  /// Calls `try_load(const Load&)` for every load in order and removes those for which it returns true. If a call
  /// throws, that load and those after it stay. `try_load` must not change this object.
  template <class TryLoad>
  void tryAll(TryLoad&& try_load) {
    for (std::size_t i = 0; i < loads_.size();) {
      if (try_load(loads_[i].load)) {
        loads_.erase(loads_.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
  }

 private:
  struct Named {
    std::string name;
    Load load;
  };
  std::vector<Named> loads_;
};

}  // namespace hgrid
