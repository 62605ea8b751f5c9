// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Distances, depths and rotations must have the same digits on all x86 and 64-bit ARM processors and with all releases
// of the C library, of Eigen and of the compiler. After a change that is meant to change digits, write the digest that
// the failed test prints into it.
#include <gtest/gtest.h>

#include <array>
#include <cstring>

#include "geometry/arc_tangent.h"
#include "geometry/rotation.h"
#include "hgrid_proximity/narrow/core_narrow_phase.h"
#include "test/support/random.h"

namespace hgrid {
namespace test {
namespace {

/// The 64-bit FNV-1a hash of numbers.
class Digest {
 public:
  void add(double number) {
    if (std::isnan(number)) number = -1.0;  // NaNs may have any sign
    if (number == 0.0) number = 0.0;        // and so may 0
    std::array<unsigned char, sizeof number> bytes;
    std::memcpy(bytes.data(), &number, sizeof number);
    for (std::size_t i = 0; i < bytes.size(); ++i) value_ = (value_ ^ bytes[i]) * 0x100000001b3u;
  }
  void add(const Eigen::Vector3d& vector) {
    for (int axis = 0; axis < 3; ++axis) add(vector[axis]);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

// The functions below use no function of the C library either, except sqrt().
Eigen::Vector3d vectorOf(Random& random) {
  const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return {x, y, z};
}

Pose poseOf(Random& random) {
  Pose pose = Pose::Identity();
  pose.linear() = rotationOf(3.0 * vectorOf(random)).toRotationMatrix();
  pose.translation() = 0.6 * vectorOf(random);
  return pose;
}

std::shared_ptr<TriangleMesh> lump(Random& random, int corners) {
  auto mesh = std::make_shared<TriangleMesh>();
  for (int i = 0; i < corners; ++i) mesh->vertices.push_back(0.3 * vectorOf(random));
  for (std::uint32_t i = 0; i + 2 < static_cast<std::uint32_t>(corners); ++i)
    mesh->triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

TEST(Digits, AreTheSameOnAllSystems) {
  Random random(17);
  const auto narrow_phase = makeCoreNarrowPhase();
  std::array<std::shared_ptr<const Solid>, 7> solids{
      narrow_phase->solidOf(Shape::sphere(0.2)),           narrow_phase->solidOf(Shape::box({0.3, 0.4, 0.1})),
      narrow_phase->solidOf(Shape::cylinder(0.5, 0.1)),    narrow_phase->solidOf(Shape::cone(0.4, 0.2)),
      narrow_phase->solidOf(Shape::capsule(0.3, 0.05)),    narrow_phase->solidOf(Shape::hull(lump(random, 12))),
      narrow_phase->solidOf(Shape::mesh(lump(random, 20)))};
  Digest digest;
  for (int i = 0; i < 100000; ++i) {
    const Pose of_first = poseOf(random), of_second = poseOf(random);
    const PlacedSolid first{*solids[static_cast<std::size_t>(random.below(7))], of_first, 0.0},
        second{*solids[static_cast<std::size_t>(random.below(7))], of_second, 0.0};
    const Proximity found = narrow_phase->measure(first, second, 1e9);
    digest.add(static_cast<double>(found.status));
    digest.add(found.distance);
    digest.add(found.lower_bound);
    digest.add(found.on_first);
    digest.add(found.normal);
    digest.add(arcTangent(of_first.translation().x(), of_first.translation().y()));
    const Eigen::Quaterniond from(of_first.linear()), to(of_second.linear());
    digest.add(between(from, to, 0.3).vec());
    if (i % 10 != 0 || !isContact(found.status)) continue;
    const Contact contact = narrow_phase->measureContact(first, second);
    digest.add(contact.depth);
    digest.add(contact.normal);
    digest.add(contact.point);
  }
  EXPECT_EQ(digest.value(), 10197732828874612958u);
}

}  // namespace
}  // namespace test
}  // namespace hgrid
