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
    using iterator_category = std::forward_iterator_tag;  ///< a copy can visit the bodies again
    using value_type = Body;                              ///< type of the visited elements
    using difference_type = std::ptrdiff_t;               ///< type of a number of steps
    using pointer = const Body*;                          ///< type of the result of ->
    using reference = const Body&;                        ///< type of the result of *

    Iterator() = default;
    /// @param at  the element of the list that the iterator points to at first
    explicit Iterator(const std::shared_ptr<const Body>* at) : at_(at) {}
    /// Returns the body that the iterator points to.
    reference operator*() const { return **at_; }
    /// Returns a pointer to the body that the iterator points to.
    pointer operator->() const { return at_->get(); }
    /// Goes to the next body.
    Iterator& operator++() { return ++at_, *this; }
    /// Goes to the next body. @returns an iterator to the previous body
    Iterator operator++(int) { return Iterator(at_++); }
    /// Whether both iterators point to the same place. They must belong to the same list.
    bool operator==(const Iterator& other) const { return at_ == other.at_; }
    /// Whether the iterators point to different places. They must belong to the same list.
    bool operator!=(const Iterator& other) const { return at_ != other.at_; }

   private:
    const std::shared_ptr<const Body>* at_ = nullptr;
  };

  BodyList() = default;
  /// Creates a list from a vector of bodies. Not explicit: a vector can be passed to a function that takes a list.
  BodyList(std::vector<Body> bodies) {
    reserve(bodies.size());
    for (Body& body : bodies) push_back(std::make_shared<const Body>(std::move(body)));
  }

  /// Returns the number of bodies.
  std::size_t size() const { return bodies_.size(); }
  /// Returns a body by its index, which must be less than size().
  const Body& operator[](std::size_t index) const { return *bodies_[index]; }
  /// Returns a body by its index. The result is never null and keeps the body alive.
  const std::shared_ptr<const Body>& share(std::size_t index) const { return bodies_[index]; }
  /// Returns an iterator to the first body.
  Iterator begin() const { return Iterator(bodies_.data()); }
  /// Returns an iterator to the place behind the last body.
  Iterator end() const { return Iterator(bodies_.data() + bodies_.size()); }
  /// Allocates memory for a number of bodies.
  void reserve(std::size_t count) { bodies_.reserve(count); }
  /// Appends a body, which must not be null.
  void push_back(std::shared_ptr<const Body> body) { bodies_.push_back(std::move(body)); }

 private:
  std::vector<std::shared_ptr<const Body>> bodies_;
};

}  // namespace hgrid
