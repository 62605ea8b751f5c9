// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/markers/marker_colors.h"

namespace hgrid {
namespace {

std_msgs::ColorRGBA colorOfKind(BodyKind kind) {
  switch (kind) {
    case BodyKind::link:
      return rgba(0.34, 0.71, 0.91, 0.7);
    case BodyKind::track:
      return rgba(0.48, 0.25, 0.85, 0.8);
    case BodyKind::map:
    case BodyKind::cloud:
      return rgba(0.62, 0.57, 0.48, 0.9);
    default:
      return rgba(0.82, 0.76, 0.64, 0.75);
  }
}

}  // namespace

std_msgs::ColorRGBA rgba(double red, double green, double blue, double alpha) {
  std_msgs::ColorRGBA color;
  color.r = static_cast<float>(red);
  color.g = static_cast<float>(green);
  color.b = static_cast<float>(blue);
  color.a = static_cast<float>(alpha);
  return color;
}

std_msgs::ColorRGBA colorOfBody(BodyKind kind, Freshness state, std::optional<double> nearness) {
  if (state >= Freshness::stale) return gray(0.7);
  const std_msgs::ColorRGBA color = colorOfKind(kind);
  if (!nearness) return color;
  const std_msgs::ColorRGBA far = rgba(1.0, 0.92, 0.2, color.a), contact = orange(color.a);
  const auto between = [&](double from, double to) { return from + *nearness * (to - from); };
  return rgba(between(far.r, contact.r), between(far.g, contact.g), between(far.b, contact.b), color.a);
}

std_msgs::ColorRGBA orange(double alpha) { return rgba(1.0, 0.55, 0.0, alpha); }
std_msgs::ColorRGBA gray(double alpha) { return rgba(0.5, 0.5, 0.5, alpha); }
std_msgs::ColorRGBA red() { return rgba(1.0, 0.25, 0.2, 1.0); }
std_msgs::ColorRGBA white() { return rgba(1.0, 1.0, 1.0, 1.0); }

}  // namespace hgrid
