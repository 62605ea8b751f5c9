// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/reconfigure/reconfigure_service.h"

#include <ros/console.h>
#include <ros/master.h>
#include <ros/this_node.h>

#include <boost/function.hpp>
#include <utility>

#include "node/health/guarded.h"
#include "node/reconfigure/reconfigure_messages.h"
#include "node/world/world.h"

namespace hgrid {
namespace {

std::string shown(const ChangeableValue& value) {
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<int>(&value)) return std::to_string(*integer);
  return text(std::get<double>(value));
}

/// Sets a parameter on the parameter server, but does not wait for a master that cannot be reached.
bool setOnServer(const std::string& name, const ChangeableValue& value) {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  request[1] = name;
  std::visit([&request](auto known) { request[2] = XmlRpc::XmlRpcValue(known); }, value);
  return ros::master::execute("setParam", request, response, payload, false);
}

}  // namespace

ReconfigureService::ReconfigureService(ros::NodeHandle private_node, const Settings& settings, ChangeWorld change_world,
                                       TakeOver take_over, Ledger& ledger)
    : node_(std::move(private_node)),
      settings_(std::make_shared<const Settings>(settings)),
      change_world_(std::move(change_world)),
      take_over_(std::move(take_over)),
      ledger_(ledger),
      descriptions_(node_.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, true)),
      updates_(node_.advertise<dynamic_reconfigure::Config>("parameter_updates", 1, true)) {
  if (descriptions_) descriptions_.publish(descriptionMessage());  // invalid if the node already ends
  if (updates_) updates_.publish(configMessage(settings_->params));
  const boost::function<bool(Event&)> callback = [this](Event& event) { return answer(event); };
  server_ = node_.advertiseService<Event>("set_parameters", callback);
}

/// Answers with the values in force, which are the old ones if the request is refused.
bool ReconfigureService::answer(Event& event) {
  return !guarded(ledger_, "set_parameters.failed", [&] {
    ledger_.count("set_parameters.asked");
    try {
      apply(changeOf(event.getRequest().value().config), printable(event.getCallerName()));
    } catch (const Refusal& refusal) {
      ledger_.refuse("set_parameters.refused", refusal);
    }
    event.getResponse().config = configMessage(settings_->params);
  });
}

void ReconfigureService::apply(const ParamChange& change, const std::string& caller) {
  const ParamChange differences = differencesOf(change, *settings_);
  if (differences.empty()) return;
  changeWorld(std::make_shared<const Settings>(changedSettings(*settings_, differences)));
  std::string list;
  for (const auto& [name, value] : differences) list += (list.empty() ? "~" : ", ~") + name + " = " + shown(value);
  ROS_INFO_STREAM("'" << caller << "' changed parameters: " << list);
  updates_.publish(configMessage(settings_->params));
  store(differences);
}

/// Lets everything take over new settings, and makes them those in force, or throws and changes nothing.
void ReconfigureService::changeWorld(const std::shared_ptr<const Settings>& settings) {
  const auto made = std::make_shared<bool>(false);  // shared: the world may call the job after this function has ended
  take_over_(settings->params);
  try {
    change_world_([settings, made](World& world) {
      world.setSettings(settings);
      *made = true;
    });
  } catch (const Refusal& refusal) {
    if (!*made) {
      take_over_(settings_->params);
      throw;
    }
    ledger_.refuse("set_parameters.late", refusal);  // the change was made, but its tick was not published in time
  }
  settings_ = settings;
}

void ReconfigureService::store(const ParamChange& change) {
  for (const auto& [name, value] : change) {
    if (setOnServer(node_.resolveName(name), value)) continue;
    ROS_WARN_STREAM("The parameter server did not store ~" << name << " = " << shown(value)
                                                           << ", because the master cannot be reached; the node "
                                                              "uses this value, but a restart will not");
    return;
  }
}

}  // namespace hgrid
