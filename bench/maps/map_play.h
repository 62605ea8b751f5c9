// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "bench/maps/map_questions.h"
#include "bench/measure/contestant.h"

namespace hgrid {
namespace bench {

/// Creates a peer from a map again and again and measures the time. Compares the leaves of the peer by a checksum.
///
/// Each time, unused heap memory is first returned to the system, as if this were the first map of the process.
/// Otherwise peers could reuse that memory, which would help trees of small nodes most.
class MakeMapPlay {
 public:
  MakeMapPlay(const Map& map, MapPeerKind::Make make) : map_(&map), make_(std::move(make)) {}

  std::vector<Sample> operator()(double budget_ms);

 private:
  const Map* map_;
  MapPeerKind::Make make_;
};

/// Measures how long a peer takes to answer questions of one kind.
///
/// First the peer answers all questions, untimed, to compare the answers. Then each sample asks kChunk questions in
/// random order. If batched, each sample asks all questions and sorts them into Morton order first, as a user with many
/// questions would do.
class AskMapPlay {
 public:
  static constexpr std::size_t kChunk = 1000;

  AskMapPlay(MapPeer& peer, MapQuestion kind, bool batched, const Map& map, const MapQuestions& questions,
             const MapDoubts& doubts);

  std::vector<Sample> operator()(double budget_ms);

 private:
  void answer(std::size_t question);
  Sample compared(const MapDoubts& doubts);
  double timed();

  MapPeer* peer_;
  MapQuestion kind_;
  bool batched_;
  const Map* map_;
  const MapQuestions* questions_;
  std::size_t next_ = 0;
  std::vector<Voxel> found_;  // leaves that answer the last question; for `touches`: any leaf means yes
  Sample result_;             // each sample is a copy of this with its own time
};

}  // namespace bench
}  // namespace hgrid
