// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/messages/robot_messages.h"

#include <hgrid_proximity/RobotOperation.h>
#include <ros/names.h>

#include <memory>
#include <optional>
#include <set>
#include <string>

#include "hgrid_proximity/bodies/name.h"
#include "node/sources/obstacle_change.h"
#include "node/text/frame_names.h"

namespace hgrid {
namespace {

namespace msg = ::hgrid_proximity;

constexpr std::size_t kLongestParameter = 512;  // [byte] length of the name of a parameter or of a tf prefix

/// Returns a name of the change for error sentences.
std::string subjectOf(const msg::RobotChange& change) {
  return change.names.empty() ? "a change without names" : "robot '" + printable(change.names.front()) + "'";
}

RobotOperation operationOf(const msg::RobotChange& change) {
  switch (change.operation) {
    case msg::RobotOperation::ADD:
      return RobotOperation::add;
    case msg::RobotOperation::REMOVE:
      return RobotOperation::remove;
    case msg::RobotOperation::ABSENT:
      return RobotOperation::declare_absent;
    case msg::RobotOperation::PRESENT:
      return RobotOperation::declare_present;
    default:
      throw Refusal(Code::unsupported, subjectOf(change) + ": operation is " + std::to_string(change.operation) +
                                           "; it must be 0 (ADD), 1 (REMOVE), 2 (ABSENT) or 3 (PRESENT)");
  }
}

void checkNames(const msg::RobotChange& change) {
  if (change.names.empty())
    throw Refusal(Code::bad_id, "names is empty; it must contain the name of at least one robot");
  std::set<std::string> names;
  for (const std::string& name : change.names) {
    checkSource(name, "the name of a robot");
    if (isReservedName(name))
      throw Refusal(Code::bad_id,
                    "a robot cannot be called '" + name + "'; obstacle, map, cloud and track are reserved");
    if (!names.insert(name).second)
      throw Refusal(Code::dup_id, "names contains '" + name + "' twice; the names must differ");
  }
}

/// @throws Refusal bad_id unless the text is short, printable UTF-8
void checkShort(const std::string& text, const std::string& what) {
  if (text.size() <= kLongestParameter && printable(text, kLongestParameter) == text) return;
  throw Refusal(Code::bad_id, what + " is '" + printable(text, 48) +
                                  "'; it must be UTF-8 without control characters, " + "of at most " +
                                  std::to_string(kLongestParameter) + " bytes");
}

/// @throws Refusal bad_id unless a parameter can have this name
void checkParameter(const std::string& name, const std::string& what) {
  checkShort(name, what);
  std::string flaw;
  if (!ros::names::validate(name, flaw))
    throw Refusal(Code::bad_id, what + " is '" + printable(name) +
                                    "', which cannot be the name of a parameter: " + printable(flaw, 300));
}

/// Checks that the change says in exactly one way where the description comes from.
void checkSourceOfDescription(const msg::RobotChange& change) {
  const int ways = !change.like.empty() + !change.description.empty() + !change.urdf.empty();
  if (ways == 0)
    throw Refusal(Code::bad_id, subjectOf(change) + ": like, description and urdf are empty; give one of them");
  if (ways > 1) {
    throw Refusal(Code::conflict, subjectOf(change) + " has " + std::to_string(ways) +
                                      " of like, description and urdf; give only one of them");
  }
  if (!change.semantic.empty() && change.description.empty())
    throw Refusal(Code::conflict,
                  subjectOf(change) + " has semantic, but no description; semantic belongs to description");
  if (!change.srdf.empty() && change.urdf.empty())
    throw Refusal(Code::conflict, subjectOf(change) + " has srdf, but no urdf; srdf belongs to urdf");
}

void checkPrefix(const msg::RobotChange& change) {
  checkShort(change.tf_prefix, "the tf_prefix of " + subjectOf(change));
  if (change.names.size() > 1 && !change.tf_prefix.empty()) {
    throw Refusal(Code::conflict, "tf_prefix is '" + printable(change.tf_prefix) + "', but the change adds " +
                                      std::to_string(change.names.size()) +
                                      " robots, whose frames must differ; leave it empty, so that each robot has its "
                                      "name as prefix, or give each robot a change of its own");
  }
}

/// Returns the text of the description; null: the change does not contain it.
std::shared_ptr<const RobotDescription> textOf(const msg::RobotChange& change, const Params& params) {
  if (change.urdf.empty()) return nullptr;
  for (const auto& [name, text] : {std::pair("urdf", &change.urdf), std::pair("srdf", &change.srdf)}) {
    if (text->size() <= static_cast<std::size_t>(params.max_description_bytes)) continue;
    throw Refusal(Code::limit, "the " + std::string(name) + " of " + subjectOf(change) + " has " +
                                   std::to_string(text->size()) + " bytes; at most " +
                                   std::to_string(params.max_description_bytes) +
                                   " are allowed (~limits/max_description_bytes)");
  }
  const std::optional<std::string> srdf = change.srdf.empty() ? std::nullopt : std::optional(change.srdf);
  return std::make_shared<const RobotDescription>(change.urdf, srdf);
}

/// Appends one request for each name of a change.
void append(const msg::RobotChange& change, std::size_t index, const Params& params,
            std::vector<RobotRequest>& requests) {
  RobotRequest request;
  request.operation = operationOf(change);
  request.index = index;
  checkNames(change);
  if (request.operation == RobotOperation::add) {
    checkSourceOfDescription(change);
    checkPrefix(change);
    if (!change.like.empty()) checkSource(change.like, "like of " + subjectOf(change));
    if (!change.description.empty()) checkParameter(change.description, "the description of " + subjectOf(change));
    if (!change.semantic.empty()) checkParameter(change.semantic, "semantic of " + subjectOf(change));
    request.like = change.like;
    request.spec.params.description = change.description;
    request.spec.params.semantic = change.semantic;
    request.spec.text = textOf(change, params);
  }
  for (const std::string& name : change.names) {
    request.spec.params.name = name;
    request.spec.params.tf_prefix = change.tf_prefix.empty() ? name : withoutSlash(change.tf_prefix);
    requests.push_back(request);
  }
}

}  // namespace

std::vector<RobotRequest> robotRequestsOf(const msg::ApplyRobots::Request& request, const Params& params) {
  const auto most = 4 * static_cast<std::size_t>(params.max_robots);
  std::size_t count = 0;
  for (const msg::RobotChange& change : request.changes) count += change.names.size();
  if (count > most || request.changes.size() > most) {
    throw Refusal(Code::limit, "the request has " + std::to_string(request.changes.size()) + " changes of " +
                                   std::to_string(count) + " robots; at most " + std::to_string(most) +
                                   " are allowed (4 * ~limits/max_robots)");
  }
  std::vector<RobotRequest> requests;
  for (std::size_t i = 0; i < request.changes.size(); ++i) {
    try {
      append(request.changes[i], i, params, requests);
    } catch (const Refusal& refusal) {
      throw ChangeRefusal(i, refusal);
    }
  }
  return requests;
}

}  // namespace hgrid
