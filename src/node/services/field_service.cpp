// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/field_service.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "hgrid_proximity/queries/distance_field.h"
#include "node/messages/to_messages.h"
#include "node/queries/query_request.h"
#include "node/queries/request_checks.h"
#include "node/services/asked_tick.h"
#include "node/wire/from_messages.h"

namespace hgrid {
namespace {

constexpr std::size_t kMostPoints = 1000000;
constexpr double kWhole = 1e-6;  // a side counts as a multiple of the resolution if it lacks less than this share of it

/// Returns the number of points along one side of the lattice. If `size` is a multiple of the resolution, the last
/// point is at the end of the side.
std::uint32_t pointsAlong(const char* axis, double size, double resolution) {
  if (!(size >= 0.0 && std::isfinite(size))) {
    throw Refusal(Code::out_of_range,
                  std::string("size.") + axis + " is " + text(size) + " m; it must be finite and not negative");
  }
  const double steps = size / resolution;
  if (!(steps < static_cast<double>(kMostPoints))) {
    throw Refusal(Code::limit, std::string("size.") + axis + " is " + text(size) + " m and resolution is " +
                                   text(resolution) + " m; a lattice has at most " + std::to_string(kMostPoints) +
                                   " points. Increase the distance of the points (resolution) or reduce size");
  }
  return static_cast<std::uint32_t>(std::floor(steps + kWhole)) + 1;
}

Lattice latticeOf(const msg::DistanceField::Request& request) {
  Lattice lattice;
  lattice.resolution = request.resolution;
  if (!(request.resolution > 0.0)) {
    throw Refusal(Code::out_of_range, "the resolution is " + text(request.resolution) + " m; it must be positive");
  }
  lattice.count = {pointsAlong("x", request.size.x, request.resolution),
                   pointsAlong("y", request.size.y, request.resolution),
                   pointsAlong("z", request.size.z, request.resolution)};
  // Each count is at most 1000000. The product of two counts fits into 64 bits, but the product of three may not.
  const std::size_t layer = std::size_t{lattice.count[0]} * lattice.count[1];
  if (layer > kMostPoints || layer * lattice.count[2] > kMostPoints) {
    throw Refusal(Code::limit, "the lattice has " + std::to_string(lattice.count[0]) + " x " +
                                   std::to_string(lattice.count[1]) + " x " + std::to_string(lattice.count[2]) +
                                   " points; at most " + std::to_string(kMostPoints) +
                                   " are allowed. Increase the distance of the points (resolution), or split the "
                                   "lattice into several requests");
  }
  return lattice;
}

}  // namespace

FieldService::FieldService(ServiceEnvelope& envelope, const Params& params, const TransformLookup& transforms,
                           const TickHistory& history, Leases& leases, std::shared_ptr<NarrowPhase> narrow_phase)
    : params_(params),
      transforms_(transforms),
      history_(history),
      leases_(leases),
      narrow_phase_(std::move(narrow_phase)),
      server_(envelope.serve<msg::DistanceField>("distance_field", [this](auto& call) { answer(call); })) {}

void FieldService::answer(ServiceCall<msg::DistanceField>& call) {
  const auto& request = call.request;
  auto& response = call.response;
  answerFromAskedTick(call, leases_, history_);
  Lattice lattice = latticeOf(request);
  const std::string no_body;
  const QueryOptions options{
      request.header.frame_id,          request.include, request.exclude, 0, true, false, no_body,
      batchDeadlineOf(request.max_time)};
  const PreparedQuery question = prepare(options, *call.tick.get(), params_, transforms_, *narrow_phase_);
  lattice.world_from_lattice = question.world_from_frame * fromPose(request.pose, "the lattice");
  DistanceField field = distanceField(question.snapshot, lattice, {request.max_distance, request.gradients != 0},
                                      *narrow_phase_, question.scope);
  const std::string outdated = namesItsTick(request) ? "" : call.tick.whyOutdated();
  if (!outdated.empty()) {
    std::fill(field.distance.begin(), field.distance.end(), DistanceField::kUnknown);
    std::fill(field.gradient.begin(), field.gradient.end(), Eigen::Vector3d::Constant(DistanceField::kUnknown));
    field.unknown = field.distance.size();
    field.because = Unknown::outdated;
    field.reason = outdated;
  }
  std::copy(lattice.count.begin(), lattice.count.end(), response.count.begin());
  response.distance = std::move(field.distance);
  response.gradient.reserve(field.gradient.size());
  for (const Eigen::Vector3d& gradient : field.gradient) response.gradient.push_back(toVector(gradient));
  response.unknown = static_cast<std::uint32_t>(field.unknown);
  response.unknown_because = static_cast<std::uint8_t>(field.because);
  response.text = std::move(field.reason);
  if (!question.frame.empty()) response.header.frame_id = question.frame;
  response.lease = leases_.keep(request.lease, call.tick.get());
}

}  // namespace hgrid
