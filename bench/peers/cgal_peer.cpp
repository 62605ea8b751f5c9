// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <CGAL/box_intersection_d.h>

#include "bench/peers/factories.h"

namespace hgrid {
namespace bench {
namespace {

/// A box with the interface that CGAL's algorithm requires.
struct CgalBox {
  using NT = float;
  using ID = std::size_t;

  Aabb box;
  ProxyId number;

  static int dimension() { return 3; }
  float min_coord(int axis) const { return box.min[axis]; }
  float max_coord(int axis) const { return box.max[axis]; }
  std::size_t id() const { return number; }
};

/// CGAL's streamed segment tree with default settings (closed boxes). It keeps no data from frame to frame.
class CgalPeer final : public Peer {
 public:
  void load(const std::vector<Aabb>&) override {}
  bool remembers() const override { return false; }

  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    boxes_.clear();
    for (std::size_t i = 0; i < frame.boxes.size(); ++i) boxes_.push_back({frame.boxes[i], static_cast<ProxyId>(i)});
    pairs.clear();
    CGAL::box_self_intersection_d(boxes_.begin(), boxes_.end(), [&](const CgalBox& a, const CgalBox& b) {
      pairs.push_back(ordered(a.number, b.number));
    });
  }

 private:
  std::vector<CgalBox> boxes_;
};

}  // namespace

std::unique_ptr<Peer> makeCgal() { return std::make_unique<CgalPeer>(); }

}  // namespace bench
}  // namespace hgrid
