// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace bench {

/// An Embree scene with one user geometry, which has one primitive per box. Embree runs with one thread.
class EmbreeScene {
 public:
  explicit EmbreeScene(RTCBuildQuality quality) {
    device_ = rtcNewDevice("threads=1,set_affinity=0");
    if (!device_) throw std::runtime_error("Embree cannot create a device");
    rtcSetDeviceMemoryMonitorFunction(device_, count, &bytes_);
    scene_ = rtcNewScene(device_);
    rtcSetSceneBuildQuality(scene_, quality);
    rtcSetSceneFlags(scene_, quality == RTC_BUILD_QUALITY_LOW ? RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_ROBUST);
    geometry_ = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryBuildQuality(geometry_, quality);
    rtcSetGeometryUserData(geometry_, this);
    rtcSetGeometryBoundsFunction(geometry_, writeBounds, nullptr);
  }
  ~EmbreeScene() {
    rtcReleaseGeometry(geometry_);
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// Sets the number of boxes and attaches the geometry to the scene.
  void attach(std::size_t count) {
    rtcSetGeometryUserPrimitiveCount(geometry_, static_cast<unsigned>(count));
    rtcAttachGeometry(scene_, geometry_);
  }

  /// Builds the scene from `boxes`. Their number must be the one given to attach(). The scene keeps a pointer to them.
  void build(const std::vector<Aabb>& boxes) {
    boxes_ = boxes.data();
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
  }

  RTCScene scene() const { return scene_; }
  RTCGeometry geometry() const { return geometry_; }
  const Aabb& box(unsigned id) const { return boxes_[id]; }
  std::size_t bytes() const { return static_cast<std::size_t>(bytes_.load()); }

 private:
  static bool count(void* bytes, ssize_t change, bool) {
    *static_cast<std::atomic<ssize_t>*>(bytes) += change;
    return true;
  }

  static void writeBounds(const RTCBoundsFunctionArguments* arguments) {
    const Aabb& box = static_cast<EmbreeScene*>(arguments->geometryUserPtr)->boxes_[arguments->primID];
    RTCBounds& bounds = *arguments->bounds_o;
    bounds.lower_x = box.min.x(), bounds.lower_y = box.min.y(), bounds.lower_z = box.min.z();
    bounds.upper_x = box.max.x(), bounds.upper_y = box.max.y(), bounds.upper_z = box.max.z();
  }

  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
  RTCGeometry geometry_ = nullptr;
  const Aabb* boxes_ = nullptr;
  std::atomic<ssize_t> bytes_{0};
};

}  // namespace bench
}  // namespace hgrid
