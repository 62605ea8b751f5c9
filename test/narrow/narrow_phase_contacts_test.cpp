// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
//
// Tests NarrowPhase::contacts(): it returns contacts exactly if the shapes touch, and each contact lies in both shapes.
// Tests NarrowPhase::measureContact(): its point lies in both shapes, and its depth separates them.
#include <gtest/gtest.h>

#include "test/narrow/narrow_phase_judge.h"

namespace hgrid {
namespace test {
namespace {

constexpr std::size_t kAll = 1000000;

std::vector<Contact> contactsOf(const Case& placed, std::size_t most = kAll, bool exchanged = false) {
  const auto first = narrowPhase().solidOf(placed.first_shape), second = narrowPhase().solidOf(placed.second_shape);
  const PlacedSolid a{*first, placed.world_from_first, placed.first_padding};
  const PlacedSolid b{*second, placed.world_from_second, placed.second_padding};
  return exchanged ? narrowPhase().contacts(b, a, most) : narrowPhase().contacts(a, b, most);
}

bool same(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a == b || (a.hasNaN() && b.hasNaN()); }

class Contacts : public testing::TestWithParam<KindPair> {};

INSTANTIATE_TEST_SUITE_P(NarrowPhase, Contacts, testing::ValuesIn(allKindPairs()),
                         [](const auto& info) { return nameOf(info.param); });

TEST_P(Contacts, AreWhereThereIsContactAndLieInBoth) {
  Cases cases(41, GetParam());
  Claim there("contacts() returns contacts exactly if measure() reports contact", 0.0);
  Claim in_both("each contact point lies in both padded shapes", 1e-6);
  Claim free("moving a convex second shape by the depth along the normal separates the shapes", 0.0);
  Claim same_order("both orders of the shapes give the same contacts", 0.0);
  Claim sorted("the deepest contacts come first", 0.0);
  const bool convex = GetParam().first != ShapeKind::mesh && GetParam().second != ShapeKind::mesh;
  for (int i = 0; i < 300; ++i) {
    const Case placed = cases.next();
    const Proximity answer = Trial(placed).measure();
    const std::vector<Contact> contacts = contactsOf(placed), exchanged = contactsOf(placed, kAll, true);
    there.hold(contacts.empty() == !isContact(answer.status), placed);
    same_order.hold(contacts.size() == exchanged.size(), placed);
    for (std::size_t k = 0; k < std::min(contacts.size(), exchanged.size()); ++k) {
      const Contact &contact = contacts[k], &other = exchanged[k];
      same_order.hold(same(contact.point, other.point) && same(contact.normal, -other.normal), placed);
      in_both.hold(
          std::max(distanceOf(placed.first(), contact.point).lower, distanceOf(placed.second(), contact.point).lower),
          placed);
      sorted.hold(k == 0 || !deeper(contact, contacts[k - 1]), placed);
      if (!convex || std::isnan(contact.depth)) continue;
      Case freed = placed;
      freed.world_from_second.translation() += (contact.depth + 1e-5) * contact.normal;
      free.hold(distanceOf(freed.first(), freed.second()).interval.lower > 0.0, placed);
    }
  }
  for (const Claim* claim : {&there, &in_both, &free, &same_order, &sorted}) claim->expectHeld();
  EXPECT_GT(in_both.count(), 20u) << "too few contacts for a meaningful test";
}

TEST_P(Contacts, OfWholeShapesHaveAPointInBothAndADepthThatSeparatesThem) {
  Cases cases(43, GetParam());
  Claim in_both("the contact point lies in both padded shapes", 1e-6);
  Claim unit("the normal is a unit vector", 1e-9);
  Claim free("moving the second shape by the depth along the normal separates the shapes", 0.0);
  Claim not_sooner("a move by less than the lower bound of the depth does not separate the shapes", 0.0);
  Claim same_order("both orders of the shapes give the same contact", 0.0);
  Claim as_measured("depth and normal are those of measure(), if it knows them", 2e-6);
  for (int i = 0; i < 100; ++i) {
    const Case placed = cases.next();
    const Trial trial(placed);
    const Proximity answer = trial.measure();
    if (!isContact(answer.status)) continue;
    const Contact contact = trial.contact(), other = trial.contactSwapped();
    same_order.hold(contact.point == other.point && contact.normal == -other.normal && contact.depth == other.depth,
                    placed);
    in_both.hold(
        std::max(distanceOf(placed.first(), contact.point).lower, distanceOf(placed.second(), contact.point).lower),
        placed);
    unit.hold(std::abs(contact.normal.norm() - 1.0), placed);
    if (!std::isnan(answer.depth)) {
      as_measured.hold(std::max(std::abs(answer.depth - contact.depth), (answer.normal - contact.normal).norm()),
                       placed);
    }
    Case freed = placed;
    freed.world_from_second.translation() += (contact.depth + 1e-5) * contact.normal;
    const SolidDistance apart = distanceOf(freed.first(), freed.second());
    free.hold(contact.depth >= 0.0 && apart.interval.lower > 0.0, placed);
    if (!(contact.depth_at_least > 1e-5)) continue;
    Case nearly = placed;
    nearly.world_from_second.translation() += (contact.depth_at_least - 1e-5) * contact.normal;
    not_sooner.hold(distanceOf(nearly.first(), nearly.second()).interval.lower, placed);
  }
  for (const Claim* claim : {&in_both, &unit, &free, &not_sooner, &same_order, &as_measured}) claim->expectHeld();
  EXPECT_GT(in_both.count(), 5u) << "too few contacts for a meaningful test";
}

}  // namespace
}  // namespace test
}  // namespace hgrid
