// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <boost/geometry.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/geometries/segment.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <utility>
#include <vector>

#include "hgrid_proximity/broadphase/broad_phase.h"

namespace hgrid {
namespace bench {

using BoostPoint = boost::geometry::model::point<float, 3, boost::geometry::cs::cartesian>;
using BoostBox = boost::geometry::model::box<BoostPoint>;
using BoostValue = std::pair<BoostBox, ProxyId>;
using BoostTree = boost::geometry::index::rtree<BoostValue, boost::geometry::index::rstar<16>>;

inline BoostPoint toBoost(const Eigen::Vector3f& v) { return {v.x(), v.y(), v.z()}; }
inline BoostBox toBoost(const Aabb& box) { return {toBoost(box.min), toBoost(box.max)}; }

/// Returns the values from which a tree is built. If Boost gets all values at once, it packs them
/// (sort-tile-recursive).
inline std::vector<BoostValue> boostValues(const std::vector<Aabb>& boxes) {
  std::vector<BoostValue> values;
  values.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) values.emplace_back(toBoost(boxes[i]), static_cast<ProxyId>(i));
  return values;
}

/// An output iterator that passes the id of each hit to a function.
template <class Take>
class BoostHits {
 public:
  explicit BoostHits(Take& take) : take_(&take) {}
  BoostHits& operator=(const BoostValue& value) {
    (*take_)(value.second);
    return *this;
  }
  BoostHits& operator*() { return *this; }
  BoostHits& operator++() { return *this; }
  BoostHits& operator++(int) { return *this; }

 private:
  Take* take_;
};

}  // namespace bench
}  // namespace hgrid
