// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/services/guard_service.h"

#include <string>
#include <utility>

#include "node/guard/path_message.h"
#include "node/messages/to_messages.h"
#include "node/states/robot_choice.h"
#include "node/time/ros_time.h"

namespace hgrid {

GuardService::GuardService(ServiceEnvelope& envelope, Guard& guard)
    : guard_(guard), server_(envelope.serve<msg::Guard>("guard", [this](auto& call) { answer(call); })) {}

void GuardService::answer(ServiceCall<msg::Guard>& call) {
  const auto& request = call.request;
  call.tick.snapshot();  // throws while there is no world
  const Tick& tick = *call.tick.get();
  if (request.positions.empty() && guard_.stopAll(request.robot)) return;
  const std::string robot = robotNamed(request.robot, tick).name;
  if (request.positions.empty()) return;
  const Time start = request.start.isZero() ? tick.made.ros : fromRos(request.start);
  RobotPath path;
  path.robot = robot;
  path.joints = request.joint_names;
  path.positions = request.positions;
  for (std::size_t i = 0; i < request.time_from_start.size(); ++i) {
    path.times.push_back(timeOfPoint(start, request.time_from_start[i], i));
  }
  const PathAnswer answer = guard_.check(guard_.follow({}, std::move(path), start, tick), tick);
  auto& response = call.response;
  response.verdict = static_cast<std::uint8_t>(answer.verdict);
  response.reason = answer.reason;
  response.free_for = answer.free_for;
  if (!answer.conflict) return;
  response.first = answer.conflict->first;
  response.second = answer.conflict->second;
  response.point = toPoint(answer.conflict->contact.point);
  response.normal = toVector(answer.conflict->contact.normal);
  response.depth = answer.conflict->contact.depth;
  response.at = toRos(answer.conflict->at);
}

}  // namespace hgrid
