// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "node/tf/tf_queue.h"

namespace hgrid {

/// Learns which messages of /tf and /tf_static a TfReader reads. The thread that reads calls it.
class TfListener {
 public:
  virtual ~TfListener() = default;
  /// Called before the first transform of a message is used.
  virtual void begins(const ReceivedTransforms& message) = 0;
  /// Called after the last transform of that message was used.
  /// @param complete  false: the rest of the message was dropped, because memory ran out
  virtual void ends(bool complete) = 0;
};

}  // namespace hgrid
