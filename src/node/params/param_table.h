// SPDX-License-Identifier: BSD-3-Clause
// SPDX-FileCopyrightText: the hgrid_proximity authors
#pragma once

#include "node/params/params.h"

namespace hgrid {

inline constexpr const char* kUnknownSpace[] = {"ignore", "report", "occupied"};
inline constexpr const char* kEmptyCloud[] = {"unknown", "clear"};
inline constexpr const char* kTrackerType[] = {"markers", "poses"};
inline constexpr const char* kKinds[] = {"self", "robot_robot", "robot_obstacle", "robot_map", "moving_obstacle"};

/// Calls the visitor for every parameter with its name, value, unit, range and meaning. There is no other table of
/// them. Calls v.changeable() before each parameter that may change while the node runs.
template <class Visitor>
void visitParams(Visitor& v, Params& p) {
  v.section("The world");
  v.string("world_frame", p.world_frame,
           "tf frame of all boxes and answers; empty: the root link of the robot; required if there are several "
           "robots, also "
           "if they are added with ~apply_robots");
  v.vector("origin", p.origin, "m", 1e6,
           "point of the world frame that boxes are stored relative to, as float32; choose a point near the robot if "
           "coordinates are large");
  v.number("rate", p.rate, "Hz", 1.0, 1000.0,
           "largest number of ticks per second, in real time also if ROS time is simulated; if follow_data is false, "
           "the number of ticks per second");
  v.number("heartbeat", p.heartbeat, "Hz", 0.1, 1000.0,
           "smallest number of ticks per second, in real time, while no data arrives; at most ~rate counts");
  v.flag("follow_data", p.follow_data,
         "whether a tick begins as soon as all frames that keep up have newer transforms, or a map, cloud or request "
         "waits; false: ticks begin at regular times");
  v.integer(
      "realtime", p.realtime, 0, 99,
      "real-time priority (SCHED_FIFO) of the thread that makes the ticks; the memory of the process is then locked in "
      "RAM. 0: usual priority");
  v.changeable();
  v.number("margin", p.margin, "m", 0.0, 1000.0, "bodies whose boxes are at most this far apart are pairs");
  v.broadPhase("broadphase/type", p.broad_phase,
               "kind of broad phase; the results are the same with each of them. hgrid was the fastest in all "
               "measured worlds; doc/partitions.md compares them");
  v.string("state_folder", p.state_folder,
           "folder in which obstacles, robots, rules and maps that services changed are stored, so that a restart "
           "keeps them; the "
           "node creates it if its parent exists, and each node needs its own. A relative path begins at the working "
           "folder of the node, which is ROS_HOME under roslaunch. Empty: nothing is stored");

  v.section("Robots");
  v.robots(
      "robots", p.robots,
      "list of {name, description, semantic, tf_prefix, joint_states}. name: name of the robot, required. "
      "description: name of the parameter that holds the URDF, required. semantic: name of the parameter that "
      "holds the SRDF; empty: there is no SRDF. tf_prefix: prefix of the robot's tf frames. joint_states: topic of "
      "its sensor_msgs/JointState messages, which tell full turns of joints apart for ~guard; default: "
      "joint_states in the namespace of description, or if it has none, in the namespace tf_prefix. Empty list: "
      "one robot named 'robot', from robot_description and robot_description_semantic");
  v.flag("watch_descriptions", p.watch_descriptions,
         "whether to look about once per second whether a description has changed, and to load that robot again; "
         "~reload_robot always does");
  v.waivers(
      "accept_uncovered", p.accept_uncovered,
      "list of {pattern, reason}: bodies that match the glob may have unreadable shapes, and the world is complete "
      "nevertheless. A robot without any collision geometry is accepted if all of its links match such globs");
  v.strings("use_visual", p.use_visual,
            "globs over body names: a link that matches and has no collision geometry uses its visual geometry");
  v.strings("mesh_roots", p.mesh_roots,
            "list of folders: file:// URIs of meshes may name files below these folders and below packages; package:// "
            "URIs are always allowed");

  v.section("Obstacles");
  v.obstacles(
      "obstacles", p.obstacles,
      "list of {name, frame, pose: {xyz: [m], rpy: [rad]}, shapes: [{type, pose, padding, ...}]}. Types and their "
      "sizes "
      "in m: box (size: [x, y, z]), sphere (radius), cylinder, cone, capsule (height, radius), hull (vertices: "
      "[[x, y, z], ...]), mesh (vertices, triangles: lists of 3 indices of vertices), plane (no size: the half-space z "
      "<= 0 "
      "of its pose; only of obstacles that are fixed in the world frame). A pose may have quaternion: "
      "[x, y, z, w] instead of rpy. frame: tf frame that the obstacle follows; empty: it is fixed in the world frame; "
      "~poses: messages of the topic ~poses move it. An obstacle may also have moving, margin, max_speed, lifetime "
      "[s], "
      "lost_at_end, owner and group, as in Obstacle.msg, and attached: {link: robot/link, pose, touch: [globs]} "
      "instead of "
      "frame "
      "and pose");
  v.flag(
      "moveit/topics", p.moveit_topics,
      "whether to read MoveIt's topics collision_object, attached_collision_object and planning_scene; their objects "
      "are obstacles of the owner 'moveit'. See doc/moveit.md");
  v.flag(
      "moveit/services", p.moveit_services,
      "whether to offer MoveIt's services get_planning_scene, apply_planning_scene and check_state_validity. Set this "
      "only where no move_group offers them in the same namespace");
  v.flag("moveit/allowed_collision_matrix", p.moveit_matrix,
         "whether the allowed collision matrix of a planning scene switches off pairs: its names of links and objects "
         "that may touch become rules, at most ~limits/max_rules. The parameter ~allowed_pairs and the service "
         "~set_allowed take precedence over equally exact rules of the matrix");

  v.section("People and vehicles");
  v.trackers(
      "tracks", p.trackers,
      "list of {name, topic, type, namespaces, shapes, upright, max_speed: [m/s], margin: [m], noise: [m], forget: "
      "[s], "
      "max_tracks}: trackers of people or vehicles. Each track is a body track/name/id. type: markers (a "
      "visualization_msgs/MarkerArray; the id of a track is namespace/id of its marker) or poses (a "
      "geometry_msgs/PoseArray with the poses of all tracks); required. namespaces: list of globs; markers of other "
      "namespaces are not tracks; default: all are tracks. shapes: as of an obstacle, in the frame of the reported "
      "pose; required. upright: whether to ignore reported orientations, so that z of the shapes is z of the world "
      "frame; default false. max_speed: upper bound of the speed of a track; default: as ~max_speed and "
      "~default_max_speed say. margin: default as ~margins and ~margin say. noise: a pose belongs to a track if the "
      "track can have moved there, or up to noise farther; default 0.2; only for type poses. forget: a track ends when "
      "it has been LOST for this long; default 5. max_tracks: largest number of tracks, default 100. See "
      "doc/tutorials/8_people_and_vehicles.md");

  v.section("Maps");
  v.maps("maps", p.maps,
         "list of {name, file or topic, frame, pose: {xyz: [m], rpy: [rad]}, max_age: [s]}: OctoMaps. Each is the body "
         "map/name. file: name of a .bt or .ot file in map/folder. topic: a topic of octomap_msgs/Octomap; "
         "octomap_binary if there is no file either. frame: tf frame that the map of a file follows; empty: it is "
         "fixed in the world frame. The map of a topic follows the frame of its messages. pose: pose of the map in its "
         "frame. max_age: the map of a topic is not complete while its newest message is older than this; 0: off");
  v.clouds(
      "clouds", p.clouds,
      "list of {name, topic, resolution: [m], lifetime: [s], empty, min_points, range: [m], min_range: [m], "
      "blind_range: [m]}: point clouds. Each is the body cloud/name. topic: a topic of sensor_msgs/PointCloud2, "
      "default cloud. resolution: edge of the cells that the points fill in the world frame, default 0.05. "
      "lifetime: how long a cell stays after the sensor last saw a point in it, default 1. The cloud is not "
      "complete if no newer message arrives within its lifetime. min_points: a message with fewer points counts "
      "as empty, default 1. empty: what an empty message means: unknown (it does not count as newer, default) or "
      "clear (nothing is there). range: the sensor sees no farther than this, default 0: no bound. Points that are "
      "as far as that or farther do not count for min_points. min_range: points nearer to the origin of their "
      "frame are beams without return, and no points, default 0.001. blind_range: how far from the sensor "
      "something may be if points are -inf, which means too near to be seen, default 0.5");
  v.string("map/folder", p.map_folder,
           "folder from which maps and ~load_octomap may read files; empty: no file is read");
  v.number("map/occupied_from", p.map_occupied_from, "", 0.001, 0.999,
           "cells with at least this probability are occupied; .bt files and octomap_binary messages contain no "
           "probabilities");
  v.flag("map/nan_is_occupied", p.map_nan_is_occupied,
         "true: a cell whose probability is NaN is occupied; false: a map with such a cell is refused");
  v.flag(
      "map/allow_empty", p.map_allow_empty,
      "true: a message or file without any node is an empty map, in which all space is unknown; false: it is refused");
  v.unknownSpace(
      "map/unknown", p.map_unknown,
      "how to treat space that a map has not observed: ignore (it counts as free), report (a query answers UNKNOWN "
      "instead of CLEAR if it passes through such space or if there is no map), occupied (it counts as occupied)");
  v.vector("map/crop_min", p.map_crop_min, "m", kNoCrop,
           "smallest corner, in the frame of the map, of the box that is read of each map; cells completely outside of "
           "the box are left out");
  v.vector("map/crop_max", p.map_crop_max, "m", kNoCrop,
           "largest corner, in the frame of the map, of the box that is read of each map");
  v.values("map/self_filter", p.map_self_filter, "padding", "m", 0.0, 10.0,
           "list of {pattern, padding}: globs over the names of links and of what robots carry. Cells that these "
           "bodies fill themselves are left out of maps and clouds: all finest cells whose centers are within padding "
           "of the padded shapes of the body, at its pose at the stamp of the map (of a file: when it is read). A "
           "padding of 0.87 cell edges leaves out all cells that touch the body. If several globs match, the last one "
           "counts. Empty list: no cells are left out");
  v.number("map/shown_within", p.map_shown_within, "m", 0.0, 1000.0,
           "~markers show the occupied cells that are within this distance of the box of a body; 0: none");
  v.strings("required", p.required,
            "globs over body names; while one of them matches no body, the world is not complete");

  v.section("Which pairs");
  v.kinds("pair_kinds", p.pair_kinds,
          "kinds of pairs that are reported. self: two links of one robot. robot_robot: links of two robots. "
          "robot_obstacle: a link and an obstacle or track. robot_map: a link and a map or cloud. moving_obstacle: an "
          "obstacle that can move, or a track, and any other obstacle, track, map or cloud. So a track counts as an "
          "obstacle that can move, and a cloud as a map. Two bodies that cannot move are never a pair");
  v.allowed("allowed_pairs", p.allowed_pairs,
            "list of {first, second, reason, allowed}: globs over body names; pairs that match may touch and are not "
            "reported; allowed: false: they are reported, even if a robot allows them");
  v.rooms("rooms", p.rooms,
          "list of {name, pose: {xyz: [m], rpy: [rad]}, size: [x, y, z]} or {name, walls: [{normal: [x, y, z], offset: "
          "[m]}]}: convex rooms with solid walls, in the world frame. Two bodies without a common room are never a "
          "pair. pose: of the center of the room; default: no rotation, at the origin. size: lengths of the sides in "
          "m. walls: each normal points out of the room and may have any length; offset: distance of the wall from the "
          "origin, along the normal. Where rooms overlap by more than 1 mm, there is no wall: the box around the "
          "common space is a door. Planes, maps, clouds and bodies with a shape in no room make pairs with everything. "
          "At most 1000. See doc/rooms.md");
  v.doors(
      "doors", p.doors,
      "list of {rooms: [name, name], pose: {xyz: [m], rpy: [rad]}, size: [x, y, z]}: openings between two of the "
      "rooms, such as doors and windows, in the world frame. A body that reaches into the box, its margin included, "
      "is in both rooms. The box must go through the whole thickness of the wall. If it is rotated, the box around "
      "it whose sides are parallel to the axes takes its place. At most 4000");
  v.values("margins", p.margins, "margin", "m", 0.0, 1000.0,
           "list of {pattern, margin}: margin of the bodies that match the glob. A pair has the larger margin of its "
           "two bodies. If several globs match, the last one counts");
  v.pairMargins("pair_margins", p.pair_margins, 0.0, 1000.0,
                "list of {first, second, margin}: globs over body names; pairs that match have this margin, larger or "
                "smaller than ~margin and those of their bodies. If several entries match, the last one counts");
  v.values("padding", p.padding, "padding", "m", 0.0, 1000.0,
           "list of {pattern, padding}: the shapes of bodies that match the glob are grown by this on all sides. If "
           "several globs match, the last one counts. Cells of maps and clouds are not grown");
  v.changeable();
  v.number("event_hysteresis", p.event_hysteresis, "m", 0.0, 1000.0,
           "~events reports the end of a pair when its gap exceeds its margin by more than this");

  v.section("Time");
  v.number("late_after", p.late_after, "s", 0.001, 3600.0,
           "a pose is LATE if it is older than this and older than 1.5 periods of its frame");
  v.number("stale_after", p.stale_after, "s", 0.001, 3600.0,
           "a pose is STALE if it is older than this and older than 1.5 periods of its frame; the margins of a body "
           "widen when its pose is older than this");
  v.number("lost_after", p.lost_after, "s", 0.001, 86400.0,
           "a pose is LOST if it is older than this and older than 1.5 periods of its frame; then the world is not "
           "complete");
  v.values("max_speed", p.max_speed, "speed", "m/s", 0.0, 1e6,
           "list of {pattern, speed}: upper bound of the speed of any point of a body that matches the glob. If "
           "several globs match, the last one counts");
  v.number("default_max_speed", p.default_max_speed, "m/s", 0.0, 1e6,
           "upper bound of the speed of bodies for which neither max_speed nor the joint velocity limits of the robot "
           "give one. A link below a joint without a limit may be faster by what the other joints allow");
  v.changeable();
  v.number("horizon", p.horizon, "s", 0.0, 60.0,
           "bodies that can meet within this time, by their speed bounds, are pairs too, with the flag HORIZON. So are "
           "bodies that passed each other between two ticks. 0: off");
  v.changeable();
  v.number("growth_cap", p.growth_cap, "m", 0.0, 1000.0, "largest length by which the margins of a stale body widen");
  v.changeable();
  v.number("valid_for", p.valid_for, "s", 0.001, 3600.0,
           "the data of a tick is valid for this long after the tick was computed (valid_until in messages)");
  v.number(
      "history", p.history, "s", 0.0, 60.0,
      "queries and ~explain_pair can ask about the ticks of this last time: they are answered from the last tick that "
      "is not later than their stamp. Queries in other frames than the world frame also need ~limits/tf_cache. 0: off");

  v.section("Exact distances");
  v.changeable();
  v.number("distances/max", p.distances_max, "m", 0.0, 1000.0,
           "~distances lists pairs whose shapes are at most this far apart; it must be at most ~margin, even if pairs "
           "have larger margins; 0: the value of ~margin. A pair of ~pair_margins is listed up to its own margin");
  v.changeable();
  v.number("distances/budget", p.distances_budget, "s", 0.0, 10.0,
           "time for measuring the distances of one tick. If it is too short for all pairs, half of it goes to the "
           "nearest pairs, and half to the pairs that have waited longest. ~events may use up to a fifth of this in "
           "addition. 0: no limit");
  v.integer("distances/threads", p.distances_threads, 1, 64, "number of threads that measure distances");

  v.section("The node");
  v.integer("threads", p.threads, 1, 64,
            "number of threads that the broad phase of a tick may use; more than 1 helps from some tens of thousands "
            "of shapes on");
  v.changeable();
  v.integer("query_threads", p.query_threads, 1, 64,
            "number of threads that answer queries; a query waits only while all of them are busy");
  v.integer("batch_threads", p.batch_threads, 1, 64,
            "number of threads that answer requests with many questions (~query_batch, ~distance_field, ~check_states, "
            "~check_edges, ~guard). Such a request may take seconds. Other queries have threads of their own "
            "(~query_threads)");
  v.pathTopics(
      "guard/topics", p.path_topics,
      "list of {topic, robot}: topics with the paths that robots are commanded to follow. The messages may be "
      "trajectory_msgs/JointTrajectory, control_msgs/FollowJointTrajectoryActionGoal or "
      "moveit_msgs/DisplayTrajectory. robot: name of the robot; default 'robot'. A robot may have several topics, for "
      "example one for each arm. A message without points ends the paths of its topic. Of an action, name the "
      "topic .../goal: the node then also reads .../cancel, .../status and .../result");
  v.number("guard/ahead", p.guard_ahead, "s", 0.1, 600.0,
           "how far ahead the paths of robots are checked (~guard, ~conflicts)");
  v.number("guard/deviation", p.guard_deviation, "rad or m", 0.0, 1000.0,
           "how far a joint may be from the path that its robot follows; if it is farther, all paths without a "
           "conflict are UNKNOWN");
  v.number("audit_rate", p.audit_rate, "Hz", 0.0, 10.0,
           "how many ticks per second are audited: a thread of low priority computes the poses, the pairs and some "
           "queries of the tick again, by brute force from the transforms as they were received; 0: none");
  v.string("audit_folder", p.audit_folder,
           "folder for a file with all data of an audit that found a difference; empty: the folder of ROS's logs");
  v.changeable();
  v.number("marker_rate", p.marker_rate, "Hz", 0.1, 100.0, "how often ~markers is published while it has subscribers");

  v.section("Limits");
  v.integer("limits/moveit_queue_bytes", p.moveit_queue_bytes, 1000, 1 << 30,
            "largest total size, in bytes, of the messages of moveit/topics that wait to be read. A message counts as "
            "its own size plus 512 bytes. A message that exceeds the limit is dropped (counter moveit.dropped.LIMIT in "
            "~status), and the world is not complete");
  v.integer(
      "limits/track_queue_bytes", p.track_queue_bytes, 1000, 1 << 30,
      "largest total size, in bytes, of the messages of one tracker that wait to be read. A message counts as its "
      "own size plus 256 bytes. When the limit is exceeded, the oldest messages are dropped (counter "
      "track/<name>.dropped.LIMIT in ~status). A single message that is longer is refused");
  v.integer("limits/max_map_bytes", p.map_max_bytes, 1000, 1 << 30,
            "largest size of a file or message of a map or cloud, in bytes");
  v.integer("limits/max_shown_cells", p.map_max_shown, 1, 1000000, "largest number of cells that ~markers show");
  v.integer("limits/max_map_leaves", p.map_max_leaves, 1, 100000000,
            "largest number of cells of a map or cloud: occupied cells and, if map/unknown is report, pieces of "
            "unknown space");
  v.number("limits/max_sync_wait", p.max_sync_wait, "s", 0.0, 10.0,
           "how far the time of a tick may stay behind the newest transform, to wait for frames that are slower");
  v.number("limits/max_future", p.max_future, "s", 0.0, 3600.0,
           "a transform whose stamp is farther in the future than this is refused");
  v.number("limits/tf_cache", p.tf_cache, "s", 1.0, 3600.0, "how long transforms are kept");
  v.number("limits/world_limit", p.world_limit, "m", 1.0, 1e6, "poses with a coordinate beyond this are refused");
  v.number("limits/min_size", p.min_size, "m", 1e-6, 1.0, "smallest radius, side or height of a shape");
  v.number("limits/max_size", p.max_size, "m", 1.0, 1e5,
           "largest radius, side, height or vertex coordinate of a shape");
  v.flag("limits/allow_flat", p.allow_flat, "true: a box may have one side of length 0");
  v.integer("limits/max_bodies", p.max_bodies, 1, 1000000, "largest number of bodies");
  v.integer("limits/max_robots", p.max_robots, 1, 10000,
            "largest number of robots, configured and added with ~apply_robots, present or absent");
  v.integer("limits/max_planes", p.max_planes, 0, 10000,
            "largest number of planes of all obstacles. A tick compares each plane with every shape that can move");
  v.integer("limits/max_maps", p.max_maps, 1, 10000,
            "largest number of maps, configured and loaded with ~load_octomap");
  v.integer(
      "limits/max_frames", p.max_frames, 1, 1000000,
      "largest number of tf frames that are kept. The frames that bodies follow, the world frame and the frames above "
      "them do not count: there is room for as many of them");
  v.integer("limits/max_samples", p.max_samples, 10, 10000000,
            "largest number of transforms of one frame that are kept, even if ~limits/tf_cache would keep more; the oldest are "
            "dropped (counter tf.samples.LIMIT in ~status)");
  v.integer("limits/tf_queue_bytes", p.tf_queue_bytes, 1000, 1 << 30,
            "largest total size, in bytes, of the messages of /tf that wait for the tick thread, and again as much for "
            "each of /tf_static and ~poses. A message counts as its own size plus 256 bytes plus the length of its "
            "publisher's name. When "
            "the limit is exceeded, the oldest messages are dropped (counter tf.dropped.LIMIT in ~status). A single "
            "message that is longer is refused");
  v.integer(
      "limits/history_bytes", p.history_bytes, 1000, 2147483647,
      "largest memory of the past ticks that history keeps, in bytes. Bodies and maps that the newest tick uses as "
      "well do not count. When the limit is reached, the history is shorter (history_begin in messages, counter "
      "history.dropped.LIMIT in ~status)");
  v.integer("limits/max_pairs", p.max_pairs, 1, 10000000,
            "largest number of pairs that a tick lists; if there are more, the list is truncated and the world is not "
            "complete");
  v.integer("limits/max_events", p.max_events, 1, 1000000,
            "largest number of events in one message of ~events; further events of a tick are in further messages");
  v.integer("limits/event_queue", p.event_queue, 1, 100000,
            "number of messages of ~events that may wait for a slow subscriber; when the queue is full, the oldest "
            "message is dropped");
  v.integer("limits/max_hits", p.max_hits, 1, 1000000,
            "largest number of hits in one answer; if there are more, the answer is truncated");
  v.integer(
      "limits/max_batch", p.max_batch, 1, 1000000,
      "largest number of questions, states or edges in a request of ~query_batch, ~check_states or ~check_edges; a "
      "request with more is refused");
  v.integer(
      "limits/max_listed", p.max_listed, 1, 100000,
      "largest number of bodies, and of sources, that a message lists as not complete or not fresh, and of entries of "
      "each list of ~status");
  v.integer("limits/max_rules", p.max_rules, 1, 10000,
            "largest number of rules of the allowed-pair matrix, including those of allowed_pairs");
  v.integer("limits/max_description_bytes", p.max_description_bytes, 1000, 256 << 20,
            "largest size of a URDF or SRDF, in bytes");
  v.integer("limits/max_description_depth", p.max_description_depth, 8, 98,
            "deepest nesting of elements in a URDF or SRDF");
  v.integer("limits/max_links", p.max_links, 1, 100000, "largest number of links of a robot");
  v.integer("limits/max_mesh_bytes", p.max_mesh_bytes, 1000, 1 << 30, "largest size of a mesh file, in bytes");
  v.integer("limits/max_mesh_triangles", p.max_mesh_triangles, 1, 100000000, "largest number of triangles of a mesh");
  v.integer("limits/mesh_memory", p.mesh_memory, 64 << 20, 2147483647,
            "largest amount of memory for reading a mesh, in bytes");
  v.number(
      "limits/mesh_timeout", p.mesh_timeout, "s", 0.1, 600.0,
      "longest time for reading a mesh; all meshes of a robot together may take 4 times as long, and the rest is not "
      "read");
  v.number(
      "limits/lease_max", p.lease_max, "s", 0.0, 3600.0,
      "longest time for which a request can make the node keep a tick (a lease), so that later requests are answered "
      "from the same tick; the node keeps at most 16 ticks");
  v.number("limits/guard_budget", p.guard_budget, "s", 0.001, 10.0,
           "longest time of one check of all paths; what was not checked in this time is UNKNOWN");
}

}  // namespace hgrid
