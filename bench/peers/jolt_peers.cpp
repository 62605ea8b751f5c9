// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// The quad trees of Jolt Physics, for all pairs and for single changes.
#include <Jolt/Jolt.h>
// Jolt.h must be the first of its headers.
#include <Jolt/Core/Memory.h>
#include <Jolt/Physics/Body/BodyCreationSettings.h>
#include <Jolt/Physics/Body/BodyManager.h>
#include <Jolt/Physics/Body/BodyPair.h>
#include <Jolt/Physics/Collision/AABoxCast.h>
#include <Jolt/Physics/Collision/BroadPhase/BroadPhaseQuadTree.h>
#include <Jolt/Physics/Collision/CastResult.h>
#include <Jolt/Physics/Collision/CollidePointResult.h>
#include <Jolt/Physics/Collision/CollideShape.h>
#include <Jolt/Physics/Collision/PhysicsMaterial.h>
#include <Jolt/Physics/Collision/Shape/Shape.h>

#include "bench/peers/factories.h"
#include "bench/singles/single_peer.h"

namespace hgrid {
namespace bench {
namespace {

JPH::AABox toJolt(const Aabb& box) {
  return {JPH::Vec3(box.min.x(), box.min.y(), box.min.z()), JPH::Vec3(box.max.x(), box.max.y(), box.max.z())};
}

/// A shape that is nothing but a box of floats. Jolt's own box has a center and half of its edges, which cannot
/// describe each box exactly.
class ExactBox final : public JPH::Shape {
 public:
  explicit ExactBox(const Aabb& box) : Shape(JPH::EShapeType::User1, JPH::EShapeSubType::User1) { set(box); }

  void set(const Aabb& box) { box_ = toJolt(box); }
  JPH::AABox GetWorldSpaceBounds(JPH::Mat44Arg, JPH::Vec3Arg) const override { return box_; }

  // The broad phase calls none of these.
  JPH::AABox GetLocalBounds() const override { return box_; }
  JPH::uint GetSubShapeIDBitsRecursive() const override { return 0; }
  float GetInnerRadius() const override { return 0.0f; }
  JPH::MassProperties GetMassProperties() const override { return {}; }
  const JPH::PhysicsMaterial* GetMaterial(const JPH::SubShapeID&) const override { return nullptr; }
  JPH::Vec3 GetSurfaceNormal(const JPH::SubShapeID&, JPH::Vec3Arg) const override { return JPH::Vec3::sZero(); }
  void GetSubmergedVolume(JPH::Mat44Arg, JPH::Vec3Arg, const JPH::Plane&, float&, float&, JPH::Vec3&) const override {}
  bool CastRay(const JPH::RayCast&, const JPH::SubShapeIDCreator&, JPH::RayCastResult&) const override { return false; }
  void CastRay(const JPH::RayCast&, const JPH::RayCastSettings&, const JPH::SubShapeIDCreator&, JPH::CastRayCollector&,
               const JPH::ShapeFilter&) const override {}
  void CollidePoint(JPH::Vec3Arg, const JPH::SubShapeIDCreator&, JPH::CollidePointCollector&,
                    const JPH::ShapeFilter&) const override {}
  void CollideSoftBodyVertices(JPH::Mat44Arg, JPH::Vec3Arg, const JPH::CollideSoftBodyVertexIterator&, JPH::uint,
                               int) const override {}
  void GetTrianglesStart(GetTrianglesContext&, const JPH::AABox&, JPH::Vec3Arg, JPH::QuatArg,
                         JPH::Vec3Arg) const override {}
  int GetTrianglesNext(GetTrianglesContext&, int, JPH::Float3*, const JPH::PhysicsMaterial**) const override {
    return 0;
  }
  Stats GetStats() const override { return {sizeof *this, 0}; }
  float GetVolume() const override { return 0.0f; }

 private:
  JPH::AABox box_;
};

/// Tells Jolt that all bodies are in one layer, and so in one tree.
class OneLayer final : public JPH::BroadPhaseLayerInterface {
 public:
  JPH::uint GetNumBroadPhaseLayers() const override { return 1; }
  JPH::BroadPhaseLayer GetBroadPhaseLayer(JPH::ObjectLayer) const override { return JPH::BroadPhaseLayer(0); }
};

/// A broad phase of Jolt with an active body for each box. The index of a body is the id of its box.
class Bodies {
 public:
  explicit Bodies(const std::vector<Aabb>& boxes) {
    JPH::RegisterDefaultAllocator();
    manager_.Init(static_cast<JPH::uint>(boxes.size()), 0, layer_);
    phase_.Init(&manager_, layer_);
    for (const Aabb& box : boxes) {
      shapes_.push_back(new ExactBox(box));
      JPH::BodyCreationSettings settings(shapes_.back(), JPH::RVec3::sZero(), JPH::Quat::sIdentity(),
                                         JPH::EMotionType::Kinematic, 0);
      settings.mCollideKinematicVsNonDynamic = true;  // otherwise Jolt leaves out pairs of such bodies
      bodies_.push_back(manager_.AllocateBody(settings));
      manager_.AddBody(bodies_.back());
      ids_.push_back(bodies_.back()->GetID());
    }
    std::vector<JPH::BodyID> order = ids_;  // Jolt sorts the list that it gets
    const int count = static_cast<int>(order.size());
    phase_.AddBodiesFinalize(order.data(), count, phase_.AddBodiesPrepare(order.data(), count));
    phase_.Optimize();
    manager_.ActivateBodies(ids_.data(), count);
  }
  Bodies(const Bodies&) = delete;
  Bodies& operator=(const Bodies&) = delete;
  ~Bodies() {
    std::vector<JPH::BodyID> order = ids_;
    manager_.DeactivateBodies(ids_.data(), static_cast<int>(ids_.size()));
    phase_.RemoveBodies(order.data(), static_cast<int>(order.size()));
    manager_.DestroyBodies(ids_.data(), static_cast<int>(ids_.size()));
  }

  void move(const std::vector<ProxyId>& ids, const std::vector<Aabb>& boxes) {
    changed_.clear();
    for (std::size_t i = 0; i < ids.size(); ++i) {
      place(ids[i], boxes[i]);
      changed_.push_back(ids_[ids[i]]);
    }
    phase_.NotifyBodiesAABBChanged(changed_.data(), static_cast<int>(changed_.size()), true);
  }
  void move(ProxyId id, const Aabb& box) {
    place(id, box);
    JPH::BodyID body = ids_[id];
    phase_.NotifyBodiesAABBChanged(&body, 1, true);
    countChange();
  }
  void replace(ProxyId id, const Aabb& box) {
    JPH::BodyID body = ids_[id];
    phase_.RemoveBodies(&body, 1);
    place(id, box);
    phase_.AddBodiesFinalize(&body, 1, phase_.AddBodiesPrepare(&body, 1));
    countChange();
  }
  /// Rebuilds the part of the tree that changed, as Jolt does in each step.
  void rebuild() {
    phase_.FrameSync();
    phase_.LockModifications();
    phase_.UpdateFinalize(phase_.UpdatePrepare());
    phase_.UnlockModifications();
  }
  void pairs(std::vector<ProxyPair>& pairs) {
    struct Collector final : JPH::BodyPairCollector {
      explicit Collector(std::vector<ProxyPair>& pairs) : pairs(pairs) {}
      void AddHit(const JPH::BodyPair& pair) override {
        pairs.push_back(ordered(pair.mBodyA.GetIndex(), pair.mBodyB.GetIndex()));
      }
      std::vector<ProxyPair>& pairs;
    } collector(pairs);
    pairs.clear();
    changed_ = ids_;
    phase_.FindCollidingPairs(changed_.data(), static_cast<int>(changed_.size()), 0.0f, {}, {}, collector);
  }
  void overlapping(const Aabb& box, std::vector<ProxyId>& found) {
    struct Collector final : JPH::CollideShapeBodyCollector {
      Collector(const Bodies& bodies, const JPH::AABox& box, std::vector<ProxyId>& found)
          : bodies(bodies), box(box), found(found) {}
      void AddHit(const JPH::BodyID& body) override {
        const ProxyId id = body.GetIndex();  // the tree enlarges the box of a body that moves
        if (box.Overlaps(bodies.bodies_[id]->GetWorldSpaceBounds())) found.push_back(id);
      }
      const Bodies& bodies;
      const JPH::AABox box;
      std::vector<ProxyId>& found;
    } collector(*this, toJolt(box), found);
    found.clear();
    phase_.CollideAABox(collector.box, collector, {}, {});
  }

 private:
  void place(ProxyId id, const Aabb& box) {
    shapes_[id]->set(box);
    bodies_[id]->CalculateWorldSpaceBoundsInternal();
  }
  /// Rebuilds the tree once in a while, because each change enlarges boxes above its leaf, and each new body is put
  /// near the root.
  void countChange() {
    constexpr int kChangesPerStep = 100;
    if (++changes_ % kChangesPerStep == 0) rebuild();
  }

  OneLayer layer_;
  JPH::BodyManager manager_;
  JPH::BroadPhaseQuadTree phase_;
  std::vector<JPH::Ref<ExactBox>> shapes_;
  std::vector<JPH::Body*> bodies_;
  std::vector<JPH::BodyID> ids_, changed_;
  int changes_ = 0;
};

class JoltPeer final : public Peer {
 public:
  void load(const std::vector<Aabb>& boxes) override { bodies_ = std::make_unique<Bodies>(boxes); }
  void frame(const Frame& frame, std::vector<ProxyPair>& pairs) override {
    bodies_->move(frame.moved, frame.moved_boxes);
    bodies_->rebuild();
    bodies_->pairs(pairs);
  }

 private:
  std::unique_ptr<Bodies> bodies_;
};

class JoltSingles final : public SinglePeer {
 public:
  void load(const std::vector<Aabb>& boxes) override { bodies_ = std::make_unique<Bodies>(boxes); }
  void update(ProxyId id, const Aabb& box) override { bodies_->move(id, box); }
  void replace(ProxyId id, const Aabb& box) override { bodies_->replace(id, box); }
  void overlapping(const Aabb& box, std::vector<ProxyId>& found) override { bodies_->overlapping(box, found); }

 private:
  std::unique_ptr<Bodies> bodies_;
};

}  // namespace

std::unique_ptr<Peer> makeJolt() { return std::make_unique<JoltPeer>(); }
std::unique_ptr<SinglePeer> makeJoltSingles() { return std::make_unique<JoltSingles>(); }

}  // namespace bench
}  // namespace hgrid
