// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "hgrid_proximity/broadphase/broad_phase_reader.h"

namespace hgrid {
namespace {

/// Calls ask(query, found) for each query. `ask` writes the answers to `found`. Replaces the content of `batch` with
/// all these answers.
template <class Query, class Found, class Ask>
void askOneByOne(const std::vector<Query>& queries, BatchOf<Found>& batch, Ask&& ask) {
  batch.begin.clear();
  batch.count.clear();
  batch.found.clear();
  std::vector<Found> found;
  for (const Query& query : queries) {
    ask(query, found);
    batch.begin.push_back(static_cast<std::uint32_t>(batch.found.size()));
    batch.count.push_back(static_cast<std::uint32_t>(found.size()));
    batch.found.insert(batch.found.end(), found.begin(), found.end());
  }
}

}  // namespace

void BroadPhaseReader::overlapping(const std::vector<Aabb>& boxes, IdBatch& found) const {
  askOneByOne(boxes, found, [this](const Aabb& box, std::vector<ProxyId>& ids) { overlapping(box, ids); });
}

void BroadPhaseReader::overlapping(const std::vector<Sphere>& spheres, IdBatch& found) const {
  askOneByOne(spheres, found, [this](const Sphere& sphere, std::vector<ProxyId>& ids) { overlapping(sphere, ids); });
}

void BroadPhaseReader::along(const std::vector<Segment>& segments, SegmentBatch& found) const {
  askOneByOne(segments, found, [this](const Segment& segment, std::vector<SegmentHit>& hits) { along(segment, hits); });
}

}  // namespace hgrid
