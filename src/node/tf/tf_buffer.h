// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <tf2/buffer_core.h>

#include <string>

#include "node/diagnostics/ledger.h"
#include "node/tf/transform_lookup.h"

namespace hgrid {

/// Feeds tf2's buffer with checked transforms. One thread writes; any thread may use lookup().
class TfBuffer {
 public:
  /// @param cache  [s] how long tf2 keeps transforms
  TfBuffer(double cache, Ledger& ledger);
  TfBuffer(const TfBuffer&) = delete;
  TfBuffer& operator=(const TfBuffer&) = delete;

  /// Stores a transform. Its quaternion is normalized first if tf2 would refuse it otherwise.
  /// @returns false if tf2 does not take it: it is older than the cache, or the frame is static already
  bool feed(const geometry_msgs::TransformStamped& transform, bool is_static, const std::string& publisher);
  /// Drops all transforms but the static ones.
  void clear() { buffer_.clear(); }

  const TransformLookup& lookup() const { return lookup_; }
  Time cache() const { return cache_; }

 private:
  Ledger& ledger_;
  Time cache_;
  tf2::BufferCore buffer_;
  TransformLookup lookup_{buffer_};
};

}  // namespace hgrid
