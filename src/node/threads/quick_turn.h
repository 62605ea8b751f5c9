// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

namespace hgrid {

/// Thrown by work that would take too long for the thread that runs it. Another thread does the work again from its
/// beginning.
struct TakesLong {};

/// While this object exists, the thread that created it runs only short work, because it must receive messages again
/// soon. A thread has at most one of these objects at a time.
class QuickTurn {
 public:
  QuickTurn() { here_ = true; }
  ~QuickTurn() { here_ = false; }
  QuickTurn(const QuickTurn&) = delete;
  QuickTurn& operator=(const QuickTurn&) = delete;

  /// Whether the calling thread may run only short work.
  static bool here() { return here_; }
  /// Does nothing if the work is short, or if the calling thread may run any work. @throws TakesLong otherwise
  static void require(bool is_short) {
    if (here_ && !is_short) throw TakesLong();
  }

 private:
  inline static thread_local bool here_ = false;
};

}  // namespace hgrid
