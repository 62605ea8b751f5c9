// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <cstddef>
#include <iterator>
#include <memory>
#include <utility>
#include <vector>

#include "hgrid_proximity/bodies/body.h"

namespace hgrid {

/// A list of bodies. Lists share the bodies, which do not change, so a copy of a list takes little time and memory.
class BodyList {
 public:
  /// Visits the bodies of a list in their order.
  class Iterator {
   public:
    using iterator_category = std::forward_iterator_tag;  ///< may visit the list more than once
    using value_type = Body;                              ///< what it visits
    using difference_type = std::ptrdiff_t;               ///< number of steps
    using pointer = const Body*;                          ///< the result of ->
    using reference = const Body&;                        ///< the result of *

    Iterator() = default;
    /// @param at  the pointer to the body that it visits first
    explicit Iterator(const std::shared_ptr<const Body>* at) : at_(at) {}
    /// Returns the present body.
    reference operator*() const { return **at_; }
    /// Returns the present body.
    pointer operator->() const { return at_->get(); }
    /// Goes to the next body.
    Iterator& operator++() { return ++at_, *this; }
    /// Goes to the next body. @returns an iterator at the present one
    Iterator operator++(int) { return Iterator(at_++); }
    /// Whether both are at the same place of one list.
    bool operator==(const Iterator& other) const { return at_ == other.at_; }
    /// Whether they are at different places of one list.
    bool operator!=(const Iterator& other) const { return at_ != other.at_; }

   private:
    const std::shared_ptr<const Body>* at_ = nullptr;
  };

  BodyList() = default;
  /// Makes a list of new bodies. Not explicit, so that a function that takes a list accepts a vector as well.
  BodyList(std::vector<Body> bodies) {
    reserve(bodies.size());
    for (Body& body : bodies) push_back(std::make_shared<const Body>(std::move(body)));
  }

  /// Returns the number of bodies.
  std::size_t size() const { return bodies_.size(); }
  /// Returns a body by its index, which must be less than size().
  const Body& operator[](std::size_t index) const { return *bodies_[index]; }
  /// Returns an iterator at the first body.
  Iterator begin() const { return Iterator(bodies_.data()); }
  /// Returns an iterator behind the last body.
  Iterator end() const { return Iterator(bodies_.data() + bodies_.size()); }
  /// Allocates memory for a number of bodies.
  void reserve(std::size_t count) { bodies_.reserve(count); }
  /// Appends a body, which must not be null.
  void push_back(std::shared_ptr<const Body> body) { bodies_.push_back(std::move(body)); }

 private:
  std::vector<std::shared_ptr<const Body>> bodies_;
};

}  // namespace hgrid
