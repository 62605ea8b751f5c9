// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <boost/shared_ptr.hpp>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "node/wire/message_bytes.h"

namespace hgrid {

/// The topics on which MoveIt's messages arrive.
enum class SceneTopic { collision_object, attached_collision_object, planning_scene };

/// Returns the name of a topic, such as "collision_object".
const char* name(SceneTopic topic);

/// A message of MoveIt that has been received but not deserialized yet.
struct ReceivedScene {
  SceneTopic topic{};
  std::string md5;  ///< of its type, as the publisher sent it
  std::string publisher;
  boost::shared_ptr<const MessageBytes> message;

  /// Returns a description of the message for error sentences.
  std::string name() const;
};

/// A queue that passes messages of MoveIt from the threads that receive them to the thread that reads them. The number
/// of bytes in it is bounded. Any thread may call any function.
class SceneQueue {
 public:
  /// Bytes that each message counts in addition to its own bytes.
  static constexpr std::size_t kOverhead = 512;

  explicit SceneQueue(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// The messages that waited.
  struct Popped {
    std::vector<ReceivedScene> messages;  ///< in the order in which they were received
    std::optional<std::size_t>
        dropped_at;              ///< number of messages that came before the newest dropped one; nullopt: none
    bool dropped_scene = false;  ///< whether a dropped message may have been a planning scene
    bool ended = false;          ///< whether end() was called
  };

  /// Appends a message, unless the queue would then exceed its bound. A message that is longer than the bound, whose
  /// bytes were not stored, is never appended. @returns whether the message was appended; false: see noteDropped()
  bool push(ReceivedScene scene);
  /// Notes that the message that was received last was dropped.
  /// @param is_scene  whether it may have been a planning scene, which can have an octomap
  void noteDropped(bool is_scene) noexcept;
  /// Waits for a message, or for a dropped one. Then removes and returns all of them.
  Popped popAll();
  /// Ends the wait in popAll().
  void end();

 private:
  const std::size_t most_bytes_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Popped waiting_;         // guarded by mutex_
  std::size_t bytes_ = 0;  // guarded by mutex_
};

}  // namespace hgrid
