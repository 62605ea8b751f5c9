// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Prints hashes of the answers of the broad phase and of a map to random queries with fixed seeds, one line for each
// kind of query. Every processor, instruction set, compiler and level of optimization must print the same lines.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "hgrid_proximity/broadphase/hgrid.h"
#include "hgrid_proximity/maps/static_grid.h"
#include "test/support/random.h"

namespace hgrid {
namespace {

using test::Random;

/// An FNV-1a hash of the bytes of numbers. It differs for -0 and 0, and for different orders of results.
class Hash {
 public:
  template <class Number>
  void add(const Number& number) {
    static_assert(std::is_arithmetic<Number>::value, "padding has no defined bytes");
    unsigned char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    for (const unsigned char byte : bytes) value_ = (value_ ^ byte) * 0x100000001b3u;
  }
  void add(const ProxyPair& pair) { add(pair.first), add(pair.second); }
  void add(const SegmentHit& hit) { add(hit.id), add(hit.along); }
  void add(const NearHit& hit) { add(hit.id), add(hit.distance); }
  void add(const Voxel& voxel) { add(voxel.x), add(voxel.y), add(voxel.z), add(voxel.level); }
  void add(const NearVoxel& near) { add(near.voxel), add(near.distance); }
  template <class Found>
  void add(const std::vector<Found>& found) {
    add(static_cast<std::uint64_t>(found.size()));
    for (const Found& one : found) add(one);
  }
  unsigned long long value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

struct Topic {
  const char* name;
  Hash hash;
};
using Topics = std::vector<Topic>;

// Uses only uniform() and powers of two, because std::exp and std::cbrt are rounded differently on different systems.
Eigen::Vector3d vectorIn(Random& random, double low, double high) {
  const double x = random.uniform(low, high), y = random.uniform(low, high);
  return {x, y, random.uniform(low, high)};
}

struct World {
  std::size_t boxes;
  double room;  // [m] edge of a cube in which each box has a corner
  Eigen::Vector3d center;
  double step;  // [m] corners are multiples of it, which makes many boxes touch; 0: not rounded
};

/// Returns a random box. On average, one in fifty boxes is large, and one in fifty has size 0.
Aabb someBox(Random& random, const World& world) {
  const int power = random.chance(0.02) ? random.between(0, 4) : random.between(-4, -1);
  const double edge = random.chance(0.02) ? 0.0 : std::ldexp(1.0, power);
  const auto rounded = [&](const Eigen::Vector3d& place) -> Eigen::Vector3f {
    if (world.step == 0.0) return place.cast<float>();
    return (world.step * (place / world.step).array().floor()).cast<float>();
  };
  const Eigen::Vector3d corner = world.center + vectorIn(random, -0.5 * world.room, 0.5 * world.room);
  const Eigen::Vector3f low = rounded(corner), size = rounded(edge * vectorIn(random, 0.1, 1.0));
  return {low, low + size};
}

/// A grid with a random world that changes in steps. Boxes move, and some boxes are removed and inserted again.
class Play {
 public:
  Play(const World& world, unsigned seed, Isa isa) : world_(world), random_(seed) {
    grid_.setIsa(isa);
    for (ProxyId id = 0; id < world.boxes; ++id) {
      ids_.push_back(id);
      boxes_.push_back(someBox(random_, world));
    }
    grid_.update(ids_, boxes_);
  }

  void frame(double share) {
    std::vector<ProxyId> moved;
    std::vector<Aabb> there;
    for (const ProxyId id : ids_) {
      if (!random_.chance(share)) continue;
      boxes_[id] = someBox(random_, world_);
      moved.push_back(id);
      there.push_back(boxes_[id]);
    }
    if (share == 1.0) {
      grid_.update(ids_, boxes_);
    } else {
      grid_.move(moved, there);
    }
    for (int i = 0; i < 5; ++i) {
      const auto id = static_cast<ProxyId>(random_.below(static_cast<int>(world_.boxes)));
      grid_.remove(id);
      if (i < 3)
        grid_.insert(id, boxes_[id]);
      else
        removed_.push_back(id);
    }
  }
  void restore() {
    for (const ProxyId id : removed_) grid_.insert(id, boxes_[id]);
    removed_.clear();
  }

  void pairs(Hash& hash) {
    std::vector<ProxyPair> pairs;
    grid_.overlappingPairs(pairs);
    hash.add(pairs);
  }
  void ask(int questions, Hash& in_boxes, Hash& in_spheres, Hash& on_segments, Hash& near) {
    std::vector<ProxyId> found;
    std::vector<SegmentHit> hits;
    std::vector<NearHit> nearest;
    for (int i = 0; i < questions; ++i) {
      const Aabb box = someBox(random_, world_);
      const Eigen::Vector3d from = box.min.cast<double>();
      const Eigen::Vector3d to = world_.center + vectorIn(random_, -0.6 * world_.room, 0.6 * world_.room);
      grid_.overlapping(box, found);
      in_boxes.add(found);
      grid_.overlapping(Sphere{from, random_.uniform(0.0, 2.0)}, found);
      in_spheres.add(found);
      grid_.along(Segment{from, to, i % 3 == 0 ? 0.0 : random_.uniform(0.0, 0.1)}, hits);
      on_segments.add(hits);
      grid_.nearest(to, 8, 5.0, nearest);
      near.add(nearest);
    }
  }

 private:
  World world_;
  Random random_;
  HGrid grid_;
  std::vector<ProxyId> ids_;
  std::vector<Aabb> boxes_;
  std::vector<ProxyId> removed_;
};

Topics broadPhase(Isa isa) {
  Topics topics = {{"pairs", {}}, {"boxes", {}}, {"spheres", {}}, {"segments", {}}, {"nearest", {}}};
  const World worlds[] = {{20000, 25.0, {0.0, 0.0, 0.0}, 0.0},
                          {4000, 10.0, {-40.0, 7.0, 3.0}, 0.125},
                          {500, 5.0, {1e5, -1e5, 1e5}, 0.0},
                          {17, 1.0, {0.0, 0.0, 0.0}, 0.0}};
  unsigned seed = 1;
  for (const World& world : worlds) {
    Play play(world, seed++, isa);
    for (const double share : {0.0, 1.0, 0.05, 0.05, 0.6}) {
      play.frame(share);
      play.pairs(topics[0].hash);
      play.ask(300, topics[1].hash, topics[2].hash, topics[3].hash, topics[4].hash);
      play.restore();
    }
  }
  return topics;
}

/// Returns a map of a floor, walls and small objects. Its voxels have several levels and do not overlap.
StaticGrid someMap() {
  Random random(5);
  std::vector<Voxel> voxels;
  const auto at = [](int key) { return static_cast<std::uint16_t>(Voxel::kOriginKey + key); };
  for (int x = -64; x < 64; x += 4) {
    for (int y = -64; y < 64; y += 4) {
      voxels.push_back({at(x), at(y), at(-4), 2});
      if (x % 32 == 0) {
        for (int z = 0; z < 32; z += 4) voxels.push_back({at(x), at(y), at(z), 2});
      } else {
        const int z = random.between(0, 40);
        voxels.push_back({at(x + random.below(4)), at(y + random.below(4)), at(z), 0});
      }
    }
  }
  std::sort(voxels.begin(), voxels.end(), [](const Voxel& a, const Voxel& b) { return mortonOf(a) < mortonOf(b); });
  return StaticGrid(0.05, voxels);
}

Topics map() {
  Topics topics = {{"map boxes", {}}, {"map spheres", {}}, {"map segments", {}}, {"map nearest", {}}};
  const StaticGrid grid = someMap();
  Random random(6);
  std::vector<Voxel> found;
  std::vector<NearVoxel> near;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d from = vectorIn(random, -4.0, 4.0), to = vectorIn(random, -4.0, 4.0);
    const Eigen::AlignedBox3d box(from, from + vectorIn(random, 0.0, 1.0));
    grid.overlapping(box, 100000, found);
    topics[0].hash.add(found);
    const Sphere sphere{to, random.uniform(0.0, 1.0)};
    grid.overlapping(sphere, 100000, found);
    topics[1].hash.add(found);
    topics[1].hash.add(grid.touches(sphere));
    const auto touch = grid.firstAlong({from, to, i % 3 == 0 ? 0.0 : random.uniform(0.0, 0.2)});
    topics[2].hash.add(touch.has_value());
    if (touch) topics[2].hash.add(touch->voxel), topics[2].hash.add(touch->along);
    grid.nearest(box, 5, 2.0, near);
    topics[3].hash.add(near);
  }
  return topics;
}

void print(const Topics& topics) {
  for (const Topic& topic : topics) std::printf("%-12s %016llx\n", topic.name, topic.hash.value());
}

int run(const std::string& set) {
  for (const Isa isa : {Isa::portable, Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon}) {
    if (name(isa) != set) continue;
    if (!isSupported(isa)) {
      std::fprintf(stderr, "this processor does not support the instruction set %s\n", name(isa));
      return 1;
    }
    print(broadPhase(isa));
    print(map());
    return 0;
  }
  std::fprintf(stderr, "unknown instruction set %s; run without arguments to list the supported ones\n", set.c_str());
  return 1;
}

void printSets() {
  for (const Isa isa : {Isa::portable, Isa::sse2, Isa::avx2, Isa::avx512, Isa::neon}) {
    if (isSupported(isa)) std::printf("%s\n", name(isa));
  }
}

}  // namespace
}  // namespace hgrid

int main(int count, char** arguments) {
  if (count == 2) return hgrid::run(arguments[1]);
  hgrid::printSets();
  return 0;
}
