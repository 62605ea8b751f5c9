// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include <XmlRpcValue.h>

#include <optional>
#include <string>
#include <vector>

#include "hgrid_proximity/adapters/octomap.h"
#include "hgrid_proximity/bodies/body.h"
#include "hgrid_proximity/broadphase/rooms.h"
#include "hgrid_proximity/pairs/pair_filter.h"
#include "hgrid_proximity/pairs/pair_margins.h"
#include "hgrid_proximity/partitions/broad_phase_type.h"

namespace hgrid {

/// A robot to load, from ~robots.
struct RobotParams {
  std::string name = "robot";                           ///< first part of the names of its bodies
  std::string description = "robot_description";        ///< parameter that holds the URDF, also in parent namespaces
  std::string semantic = "robot_description_semantic";  ///< parameter that holds the SRDF, if there is one
  std::string tf_prefix;                                ///< its tf frames are "tf_prefix/link"; empty: "link"
  std::string joint_states = {};  ///< topic of its sensor_msgs/JointState messages; empty: see jointStatesTopic()
};

/// The link that an obstacle of ~obstacles is attached to.
struct AttachedParams {
  std::string link;                        ///< full name: "robot/tool0"
  Pose link_from_body = Pose::Identity();  ///< pose of the obstacle in the frame of the link
  std::vector<std::string> touch;          ///< globs over the names of bodies that may touch the obstacle
};

/// An obstacle from ~obstacles.
struct ObstacleParams {
  Body body;                 ///< its name, frame (empty: the world frame), pose in that frame, and shapes with paddings
  bool moving = false;       ///< whether it makes pairs with fixed bodies even if it follows the world frame
  double margin = 0.0;       ///< [m] 0: as ~margins and ~margin say
  double max_speed = 0.0;    ///< [m/s] 0: as ~max_speed and ~default_max_speed say
  double lifetime = 0.0;     ///< [s] of ROS time, from its last change; 0: unlimited
  bool lost_at_end = false;  ///< at the end of its lifetime, it becomes LOST; otherwise it is removed
  std::string owner = {};    ///< who is responsible for it; empty: nobody
  std::optional<AttachedParams> attached = {};  ///< the link that it follows instead of its frame; nullopt: none
};

/// A map from ~maps. Its cells come from a file or from a topic.
struct MapParams {
  std::string name;   ///< name without the source: the body is map/name
  std::string file;   ///< name of a file in ~map/folder; empty: the map comes from a topic
  std::string topic;  ///< topic of octomap_msgs/Octomap messages; the map follows their frame
  std::string frame;  ///< frame that the map of a file follows; empty: the world frame
  Pose frame_from_map = Pose::Identity();
  double max_age = 0.0;  ///< [s] a map of a topic is incomplete if its newest message is older; 0: off
};

/// What an empty cloud message means. A message is empty if it has fewer finite points than CloudParams::min_points.
enum class EmptyCloud : std::uint8_t {
  unknown,  ///< the sensor did not see anything: the message does not make the cloud fresh
  clear,    ///< the sensor saw that nothing is there
};

/// A point cloud from ~clouds.
struct CloudParams {
  std::string name;             ///< name without the source: the body is cloud/name
  std::string topic = "cloud";  ///< topic of sensor_msgs/PointCloud2 messages
  double resolution = 0.05;     ///< [m] edge of its cells
  double lifetime = 1.0;        ///< [s] how long a cell stays after the sensor last saw it
  EmptyCloud empty = EmptyCloud::unknown;
  int min_points = 1;  ///< a message with fewer finite points is empty
  double range = 0.0;  ///< [m] the sensor sees no farther than this, so a lost cloud hides nothing beyond; 0: no bound
  double min_range = 0.001;  ///< [m] points nearer to the origin of the cloud's frame are beams without return
  double blind_range = 0.5;  ///< [m] where something may be if points of the cloud are -inf, "too near"
};

/// What a tracker publishes.
enum class TrackerType : std::uint8_t {
  markers,  ///< visualization_msgs/MarkerArray: each marker is a track; its namespace and id identify it
  poses,    ///< geometry_msgs/PoseArray: each message has the poses of all tracks, without ids
};

/// A tracker of people or vehicles from ~tracks.
struct TrackerParams {
  std::string name;   ///< name without the source, and without a slash: the bodies are track/name/id
  std::string topic;  ///< topic of its messages
  TrackerType type = TrackerType::markers;
  std::vector<std::string> namespaces;  ///< globs: only markers of these namespaces are tracks; empty: all are
  std::vector<BodyShape> shapes;        ///< the shape of each track, in the frame of its pose
  bool upright = false;                 ///< whether a track has the orientation of the world frame, whatever it reports
  double max_speed = 0.0;               ///< [m/s] 0: as ~max_speed and ~default_max_speed say
  double margin = 0.0;                  ///< [m] 0: as ~margins and ~margin say
  double noise = 0.2;                   ///< [m] largest error of a reported position
  double forget = 5.0;                  ///< [s] how long a track is LOST before it ends
  int max_tracks = 100;                 ///< largest number of tracks
};

/// A topic with the paths that a robot is commanded to follow, from ~guard/topics.
struct PathTopicParams {
  std::string topic;            ///< topic of its messages; their type is found when they arrive
  std::string robot = "robot";  ///< name of the robot
};

/// [m] Corner coordinate of a crop box that is larger than any map.
constexpr double kNoCrop = 1e7;

/// A value for all bodies whose names match a glob.
struct PatternValue {
  std::string pattern;
  double value = 0.0;
};

/// Accepts that the bodies whose names match `pattern` are uncovered, for a reason.
struct Waiver {
  std::string pattern, reason;
};

/// All parameters of the node. visitParams() in param_table.h is the only table of their units, ranges and meanings.
/// config/params.yaml and doc/parameters.md show this table; a test checks that they agree with it.
struct Params {
  std::string world_frame;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  double rate = 50.0, heartbeat = 20.0;
  bool follow_data = true;
  int realtime = 0;
  double margin = 0.10;
  BroadPhaseType broad_phase = BroadPhaseType::hgrid;

  std::vector<RobotParams> robots;
  bool watch_descriptions = true;
  std::vector<ObstacleParams> obstacles;
  bool moveit_topics = false, moveit_services = false, moveit_matrix = false;
  int moveit_queue_bytes = 64 << 20;
  std::vector<MapParams> maps;
  std::vector<CloudParams> clouds;
  std::vector<TrackerParams> trackers;
  int track_queue_bytes = 4 << 20;
  std::string map_folder;
  double map_occupied_from = 0.5;
  bool map_nan_is_occupied = false, map_allow_empty = false;
  UnknownSpace map_unknown = UnknownSpace::ignore;
  Eigen::Vector3d map_crop_min = Eigen::Vector3d::Constant(-kNoCrop), map_crop_max = Eigen::Vector3d::Constant(kNoCrop);
  int map_max_bytes = 256 << 20, map_max_leaves = 20000000, map_max_shown = 20000;
  double map_shown_within = 1.0;
  std::vector<PairRule> allowed_pairs;
  PairKinds pair_kinds;
  std::vector<Room> rooms;
  std::vector<Portal> doors;
  std::vector<Waiver> accept_uncovered;
  std::vector<std::string> required, use_visual;
  std::vector<PairMargin> pair_margins;
  std::vector<PatternValue> margins, padding, max_speed, map_self_filter;
  double event_hysteresis = 0.02;

  double late_after = 0.1, stale_after = 0.25, lost_after = 2.0;
  double horizon = 0.0;
  double growth_cap = 1.0, default_max_speed = 2.0;
  double max_sync_wait = 0.1, max_future = 0.5, tf_cache = 10.0, valid_for = 0.1;
  double history = 2.0;

  double world_limit = 1e6, min_size = 1e-4, max_size = 1e5;
  bool allow_flat = false;
  int threads = 1;
  int max_bodies = 100000, max_planes = 64, max_robots = 1000, max_maps = 100, max_frames = 10000, max_samples = 10000,
      tf_queue_bytes = 16 << 20;
  int history_bytes = 64 << 20;
  int max_pairs = 100000, max_events = 10000, event_queue = 100;
  int max_hits = 10000, max_batch = 100000, max_listed = 100, max_rules = 1000;
  int max_description_bytes = 16 << 20, max_description_depth = 98, max_links = 2000;
  std::vector<std::string> mesh_roots;
  int max_mesh_bytes = 64 << 20, max_mesh_triangles = 1000000, mesh_memory = 512 << 20;
  double mesh_timeout = 5.0;
  int query_threads = 8, batch_threads = 2;
  double lease_max = 10.0;
  std::vector<PathTopicParams> path_topics;
  double guard_ahead = 10.0, guard_deviation = 0.1, guard_budget = 1.0;
  double marker_rate = 5.0;
  double audit_rate = 0.2;
  std::string audit_folder;
  std::string state_folder;

  double distances_max = 0.0, distances_budget = 0.005;
  int distances_threads = 1;

  /// Returns the largest distance [m] of the pairs in ~distances.
  double reportDistance() const { return distances_max == 0.0 ? margin : distances_max; }
  ShapeLimits shapeLimits() const { return {min_size, max_size, allow_flat}; }
};

/// Returns whether a robot cannot have this name, because another kind of source has it: obstacle, map, cloud or track.
bool isReservedName(const std::string& robot);

/// Reads all parameters of the node.
/// @param values  the private namespace of the node, as one struct
/// @throws std::invalid_argument with one message that lists every wrong, out-of-range and unknown parameter.
Params readParams(XmlRpc::XmlRpcValue values);
/// As above, but adds a sentence to `errors` for every such parameter instead of throwing.
/// @returns the parameters; they are of use only if nothing was added
Params readParams(XmlRpc::XmlRpcValue values, std::vector<std::string>& errors);

/// Returns the text of config/params.yaml: every parameter with its unit, default, range and meaning.
std::string paramsAsYaml();

/// Returns the text of doc/parameters.md: the same, as one table for each topic.
std::string paramsAsMarkdown();

}  // namespace hgrid
