// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "bench/maps/map_questions.h"
#include "bench/measure/contestant.h"

namespace hgrid {
namespace bench {

/// How a peer is made of a map, again and again, and its leaves compared. Each time the heap has been given back
/// before, as if it were the first map of the process: memory that is still there would save a tree of small nodes
/// most.
class MakeMapPlay {
 public:
  MakeMapPlay(const Map& map, MapPeerKind::Make make) : map_(&map), make_(std::move(make)) {}

  std::vector<Sample> operator()(double budget_ms);

 private:
  const Map* map_;
  MapPeerKind::Make make_;
};

/// How a peer answers questions of one kind: first all, untimed, to be compared; then kChunk of them per sample in
/// random order; or, batched, all of them per sample, which puts them in Morton order first, as one would who has many.
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
  std::vector<Voxel> found_;  // of the last question; of a ball that only has to touch: one without meaning
  Sample result_;             // what every sample carries beside its time
};

}  // namespace bench
}  // namespace hgrid
