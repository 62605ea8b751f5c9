// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>

namespace hgrid {

/// The name of a publisher, which many frames share. Null: no publisher.
using SharedName = std::shared_ptr<const std::string>;

/// The publisher of one message, while its transforms are compared with those of other messages.
///
/// Frames that have the same publisher usually share one string. So only the first of them is compared by its
/// characters.
class MessagePublisher {
 public:
  /// @param name  must outlive this object
  explicit MessagePublisher(const std::string& name) : name_(name) {}

  const std::string& name() const { return name_; }
  /// Whether this publisher has the name `other`.
  bool is(const SharedName& other) {
    if (other == nullptr) return false;
    if (other == shared_) return true;
    if (*other != name_) return false;
    shared_ = other;
    return true;
  }
  /// Returns the name, for frames.
  const SharedName& shared() {
    if (shared_ == nullptr) shared_ = std::make_shared<const std::string>(name_);
    return shared_;
  }

 private:
  const std::string& name_;
  SharedName shared_;
};

}  // namespace hgrid
