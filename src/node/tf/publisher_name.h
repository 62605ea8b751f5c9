// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>

namespace hgrid {

/// The name of a publisher, which many frames share. Null: no publisher.
using SharedName = std::shared_ptr<const std::string>;

/// The publisher of one message. Frames of one publisher share one string where possible. Then comparing two publishers
/// means comparing two addresses, and no characters.
class MessagePublisher {
 public:
  /// @param name  must outlive this object
  explicit MessagePublisher(const std::string& name) : name_(name) {}

  const std::string& name() const { return name_; }
  /// Returns whether `other` is the name of this publisher. If it is, also lets `other` share the string of this
  /// object.
  bool is(SharedName& other) {
    if (other == nullptr) return false;
    if (other == shared_) return true;
    if (*other != name_) return false;
    if (shared_ == nullptr) {
      shared_ = other;
    } else {
      other = shared_;
    }
    return true;
  }
  /// Returns the name as a string that frames can share. Only the first call allocates memory.
  const SharedName& shared() {
    if (shared_ == nullptr) shared_ = std::make_shared<const std::string>(name_);
    return shared_;
  }

 private:
  const std::string& name_;
  SharedName shared_;
};

}  // namespace hgrid
