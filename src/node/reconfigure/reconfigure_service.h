// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>

#include <functional>
#include <memory>
#include <string>

#include "node/health/ledger.h"
#include "node/params/settings.h"
#include "node/tick/change_world.h"
#include "node/wire/checked.h"

namespace hgrid {

/// Changes parameters while the node runs, as a server of dynamic_reconfigure: the service ~set_parameters and the
/// latched topics ~parameter_descriptions and ~parameter_updates.
///
/// All values of a request are checked together. Then one tick takes them over, all of them or none. A request that is
/// refused changes nothing: its answer has the values in force, and a warning in the log says why. The parameter server
/// gets the new values, so that a restart of the node keeps them.
class ReconfigureService {
 public:
  /// Takes over new parameters outside of the world. It is called with the new ones before the world changes, and with
  /// the old ones if the world then refuses the change. It may throw, and must then leave everything as before.
  using TakeOver = std::function<void(const Params&)>;

  /// @param private_node  node handle whose namespace contains the topics and the service. Only one thread may run the
  ///                      callbacks of its queue.
  /// @param settings      the settings in force
  /// @param change_world  passes new settings to the world
  /// @param take_over     see TakeOver
  /// @param ledger        must outlive this object
  ReconfigureService(ros::NodeHandle private_node, const Settings& settings, ChangeWorld change_world,
                     TakeOver take_over, Ledger& ledger);
  ReconfigureService(const ReconfigureService&) = delete;
  ReconfigureService& operator=(const ReconfigureService&) = delete;

 private:
  using Service = dynamic_reconfigure::Reconfigure;
  using Event = ros::ServiceEvent<Checked<Service::Request>, Service::Response>;
  bool answer(Event& event);
  void apply(const ParamChange& change, const std::string& caller);
  void changeWorld(const std::shared_ptr<const Settings>& settings);
  void store(const ParamChange& change);

  ros::NodeHandle node_;
  std::shared_ptr<const Settings> settings_;  // those in force
  ChangeWorld change_world_;
  TakeOver take_over_;
  Ledger& ledger_;
  ros::Publisher descriptions_, updates_;
  ros::ServiceServer server_;
};

}  // namespace hgrid
