// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include <ode/ode.h>

#include <cmath>

#include "bench/peers/factories.h"

namespace hgrid {
namespace bench {
namespace {

/// The user data of an ODE geometry. ODE calls writeBox() to get the box of the geometry.
struct Body {
  const Aabb* box;
  ProxyId id;
};

Body& bodyOf(dGeomID geom) { return *static_cast<Body*>(dGeomGetClassData(geom)); }

void writeBox(dGeomID geom, dReal* bounds) {
  const Aabb& box = *bodyOf(geom).box;
  for (int axis = 0; axis < 3; ++axis) {
    bounds[2 * axis] = box.min[axis];
    bounds[2 * axis + 1] = box.max[axis];
  }
}

/// Returns the number of a class of ODE geometries that have only a box.
int boxClass() {
  static const int number = [] {
    dInitODE2(0);
    dGeomClass kind{};
    kind.bytes = sizeof(Body);
    kind.collider = [](int) -> dColliderFn* { return nullptr; };
    kind.aabb = writeBox;
    return dCreateGeomClass(&kind);
  }();
  return number;
}

class OdePeer : public Peer {
 public:
  ~OdePeer() override {
    if (space_) dSpaceDestroy(space_);  // also destroys the geometries in it
  }

  void load(const std::vector<Aabb>& boxes) override {
    const int kind = boxClass();
    boxes_ = boxes;
    space_ = makeSpace(boxes);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const dGeomID geom = dCreateGeom(kind);
      bodyOf(geom) = {&boxes_[i], static_cast<ProxyId>(i)};
      geoms_.push_back(geom);
      dSpaceAdd(space_, geom);
    }
  }

  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    for (std::size_t i = 0; i < frame.moved.size(); ++i) {
      boxes_[frame.moved[i]] = frame.moved_boxes[i];
      dGeomSetPosition(geoms_[frame.moved[i]], 0, 0, 0);  // marks the geometry as moved
    }
    pairs.clear();
    dSpaceCollide(space_, &pairs, [](void* found, dGeomID a, dGeomID b) {
      const Body &first = bodyOf(a), &second = bodyOf(b);
      if (overlap(*first.box, *second.box))
        static_cast<std::vector<ProxyPair>*>(found)->push_back(ordered(first.id, second.id));
    });
  }

 protected:
  virtual dSpaceID makeSpace(const std::vector<Aabb>& boxes) const = 0;

 private:
  std::vector<Aabb> boxes_;
  std::vector<dGeomID> geoms_;
  dSpaceID space_ = nullptr;
};

class HashPeer final : public OdePeer {
  dSpaceID makeSpace(const std::vector<Aabb>& boxes) const override {
    float least = 1e30f, most = 0.f;
    for (const Aabb& box : boxes) {
      const float edge = (box.max - box.min).maxCoeff();
      least = std::min(least, edge);
      most = std::max(most, edge);
    }
    const dSpaceID space = dHashSpaceCreate(nullptr);
    dHashSpaceSetLevels(space, std::ilogb(least), std::ilogb(most) + 1);
    return space;
  }
};

class SapPeer final : public OdePeer {
  dSpaceID makeSpace(const std::vector<Aabb>&) const override {
    return dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ);
  }
};

}  // namespace

std::unique_ptr<Peer> makeOdeHash() { return std::make_unique<HashPeer>(); }
std::unique_ptr<Peer> makeOdeSap() { return std::make_unique<SapPeer>(); }

}  // namespace bench
}  // namespace hgrid
