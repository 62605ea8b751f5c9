// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <memory>
#include <string>

namespace hgrid {

/// The name of a publisher, which many frames share. Null: no publisher.
using SharedName = std::shared_ptr<const std::string>;

/// The publisher of one message. Frames of this publisher get the same string, so that most of them are compared by its
/// address, not by its characters.
class MessagePublisher {
 public:
  /// @param name  must outlive this object
  explicit MessagePublisher(const std::string& name) : name_(name) {}

  const std::string& name() const { return name_; }
  /// Whether this publisher has the name `other`. Then also lets `other` refer to the string of this publisher.
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
  /// Returns the name, for frames. The first call may allocate memory; later calls do not throw.
  const SharedName& shared() {
    if (shared_ == nullptr) shared_ = std::make_shared<const std::string>(name_);
    return shared_;
  }

 private:
  const std::string& name_;
  SharedName shared_;
};

}  // namespace hgrid
