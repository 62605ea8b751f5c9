// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "node/tf/tf_queue.h"

namespace hgrid {

/// An object that a TfReader calls for each message of /tf and /tf_static that it reads. The calls come from the thread
/// that reads the messages.
class TfListener {
 public:
  virtual ~TfListener() = default;
  /// Called before the first transform of a message is used.
  virtual void begins(const ReceivedTransforms& message) = 0;
  /// Called after the last transform of the message was used. begins() was called for the same message.
  /// @param complete  false: the rest of the message was dropped, because memory ran out
  virtual void ends(bool complete) = 0;
};

}  // namespace hgrid
