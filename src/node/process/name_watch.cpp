// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#include "node/process/name_watch.h"

#include <ros/connection_manager.h>
#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>

#include <string>

#include "hgrid_proximity/refusal.h"

namespace hgrid {
namespace {

constexpr const char* kReasonOfMaster = "new node registered with same name";

/// Returns the reason that a request `shutdown` gives. The reason is optional, so it may be empty.
std::string reasonOf(XmlRpc::XmlRpcValue& params) {
  const bool given = params.getType() == XmlRpc::XmlRpcValue::TypeArray && params.size() > 1 &&
                     params[1].getType() == XmlRpc::XmlRpcValue::TypeString;
  return given ? static_cast<std::string&>(params[1]) : "";
}

/// Asks the master of this node for the URI of a node or of a service. Empty: it knows none.
std::string uriOf(const char* method, const std::string& name) {
  XmlRpc::XmlRpcValue request, response, uri;
  request[0] = ros::this_node::getName();
  request[1] = name;
  const bool found =
      ros::master::execute(method, request, response, uri, false) && uri.getType() == XmlRpc::XmlRpcValue::TypeString;
  return found ? static_cast<std::string&>(uri) : "";
}

/// Asks the master of this node whether another node has taken the name of this node. Returns false if the master does
/// not answer: then the request to shut down came from another master. If the process of the master is stopped, this
/// function waits until it continues. Meanwhile no other node can connect to this one.
///
/// If this node registers something after another node took the name, this node has the name again, but the master has
/// dropped what this node had registered before. So this also asks for the service that roscpp registers first.
bool isNameTaken() {
  if (!ros::master::check()) return false;
  const std::string& name = ros::this_node::getName();
  const std::string services =
      "rosrpc://" + ros::network::getHost() + ":" + std::to_string(ros::ConnectionManager::instance()->getTCPPort());
  return uriOf("lookupNode", name) != ros::XMLRPCManager::instance()->getServerURI() ||
         uriOf("lookupService", name + "/get_loggers") != services;
}

}  // namespace

NameWatch::NameWatch() {
  const auto on_shutdown = [taken = taken_](XmlRpc::XmlRpcValue& params, XmlRpc::XmlRpcValue& result) {
    const std::string reason = reasonOf(params);
    result = ros::xmlrpc::responseInt(1, "", 0);
    if (reason.find(kReasonOfMaster) != std::string::npos) {
      if (!*taken && !isNameTaken()) {
        ROS_WARN(
            "A ROS master requested the shutdown of this node with the reason '%s'. But the master of this node, %s, "
            "knows no other node of the name '%s', or it does not answer. The request is probably meant for an earlier "
            "node that used the same port, so this node ignores it.",
            printable(reason).c_str(), ros::master::getURI().c_str(), ros::this_node::getName().c_str());
        return;
      }
      if (!taken->exchange(
              true)) {  // the master may ask twice, because two registrations of the other node may be under way
        ROS_ERROR(
            "Another node has registered under the name '%s', so this node ends with exit code %d. A name can belong "
            "to one node only: end the launch of one of the two nodes, or start one of them with another __name.",
            ros::this_node::getName().c_str(), kExitCode);
      }
    } else {
      ROS_WARN("This node ends because another process requested its shutdown. The request gives %s.",
               reason.empty() ? "no reason" : ("the reason '" + printable(reason) + "'").c_str());
    }
    ros::requestShutdown();
  };
  // roscpp later binds its own handler to the same name. That has no effect, because this handler was bound first.
  ros::XMLRPCManager::instance()->bind("shutdown", on_shutdown);
}

}  // namespace hgrid
