// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "bench/maps/map_questions.h"
#include "bench/measure/contestant.h"

namespace hgrid {
namespace bench {

/// Creates a peer from a map again and again and measures the time. A checksum of the peer's leaves shows whether they
/// are right.
///
/// Before each creation, unused heap memory is returned to the system, as if the map were the first one of the process.
/// A peer that reused this memory would seem faster, most of all a tree of small nodes.
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
/// First the peer answers all questions without timing; these answers are compared. Then each sample times kChunk
/// questions in random order. If `batched` is true, each sample instead asks all questions: small spheres in one call,
/// other questions sorted into Morton order, as a user with many questions would do.
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
  std::vector<Voxel> found_;  // leaves that answer the last question; for `touches`, any leaf means "yes"
  Sample result_;             // template of all samples; only their times differ
};

}  // namespace bench
}  // namespace hgrid
