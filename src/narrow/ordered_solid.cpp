// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "narrow/ordered_solid.h"

#include <algorithm>

namespace hgrid {
namespace {

using Vector = Eigen::Vector3d;

/// Whether `a` comes after `b` in the order in which two solids are measured.
bool goesAfter(const Side& a, const Side& b) {
  if (b.solid.before(a.solid)) return true;
  if (a.solid.before(b.solid)) return false;
  if (a.around != b.around) return b.around < a.around;
  const auto &m = a.world_from_shape.matrix(), &n = b.world_from_shape.matrix();
  for (Eigen::Index i = 0; i < 16; ++i) {
    if (m.data()[i] != n.data()[i]) return n.data()[i] < m.data()[i];
  }
  return false;
}

Proximity inWorld(Proximity result, const Side& frame) {
  result.on_first = frame.world_from_shape * result.on_first;
  result.on_second = frame.world_from_shape * result.on_second;
  result.normal = frame.world_from_shape.linear() * result.normal;
  return result;
}

/// @param exchanged  whether the contact is that of the exchanged solids
void toWorld(Contact& contact, const Side& frame, bool exchanged) {
  contact.point = frame.world_from_shape * contact.point;
  contact.normal = frame.world_from_shape.linear() * contact.normal;
  if (exchanged) contact.normal = -contact.normal;
}

/// Returns the radius around the core of a shape [m].
double radiusOf(const Shape& shape) {
  if (shape.kind() == ShapeKind::sphere) return shape.dimensions()[0];
  return shape.kind() == ShapeKind::capsule ? shape.dimensions()[1] : 0.0;
}

}  // namespace

OrderedSolid::OrderedSolid(const Shape& shape)
    : kind_(shape.kind()),
      size_(shape.dimensions()),
      source_(shape.mesh()),
      reach_(shape.reach()),
      radius_(radiusOf(shape)) {}

bool OrderedSolid::before(const OrderedSolid& other) const {
  if (kind_ != other.kind_) return kind_ > other.kind_;  // planes, then meshes have the largest numbers
  if (size_ != other.size_) return size_ < other.size_;
  if (source_ == other.source_ || !source_ || !other.source_) return false;
  const auto &v = source_->vertices, &w = other.source_->vertices;
  const auto less = [](const Vector& a, const Vector& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  };
  if (std::lexicographical_compare(v.begin(), v.end(), w.begin(), w.end(), less)) return true;
  if (std::lexicographical_compare(w.begin(), w.end(), v.begin(), v.end(), less)) return false;
  return source_->triangles < other.source_->triangles;
}

Proximity OrderedNarrowPhase::measure(const PlacedSolid& first, const PlacedSolid& second, double up_to) const {
  const Side a(first), b(second);
  Proximity result;
  try {
    if (!goesAfter(a, b)) return inWorld(measureInOrder(a, b, up_to), a);
    result = inWorld(measureInOrder(b, a, up_to), b);
    std::swap(result.on_first, result.on_second);
    result.normal = -result.normal;
  } catch (const std::exception&) {
    result = Proximity{};
    result.status = Measure::failed;
    result.distance = 0.0;
  }
  return result;
}

Contact OrderedNarrowPhase::measureContact(const PlacedSolid& first, const PlacedSolid& second) const {
  const Side a(first), b(second);
  const bool exchanged = goesAfter(a, b);
  try {
    Contact contact = exchanged ? measureContactInOrder(b, a) : measureContactInOrder(a, b);
    toWorld(contact, exchanged ? b : a, exchanged);
    return contact;
  } catch (const std::exception&) {
    return {};
  }
}

std::vector<Contact> OrderedNarrowPhase::contacts(const PlacedSolid& first, const PlacedSolid& second,
                                                  std::size_t most) const {
  const Side a(first), b(second);
  const bool exchanged = goesAfter(a, b);
  std::vector<Contact> found = exchanged ? contactsInOrder(b, a, most) : contactsInOrder(a, b, most);
  for (Contact& contact : found) toWorld(contact, exchanged ? b : a, exchanged);
  std::stable_sort(found.begin(), found.end(), [](const Contact& m, const Contact& n) { return deeper(m, n); });
  return found;
}

}  // namespace hgrid
