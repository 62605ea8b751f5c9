# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Asks the proximity node, and listens to it.

    import rospy
    from hgrid_proximity.client import Proximity

    rospy.init_node("my_program")
    proximity = Proximity()
    answer = proximity.query_sphere((0.6, 0.2, 0.3), radius=0.1, exclude="robot/*")
    if answer.clear:
        ...

Coordinates are in meters. Points and sizes are three numbers, or messages with the fields x, y and z. The modules
`hgrid_proximity.errors`, `.events` and `.streams` describe what can go wrong, how to wait for events, and the arrays;
`.obstacles`, `.robots` and `.rules` make the changes for apply_obstacles(), apply_robots() and set_allowed().
"""
from __future__ import annotations

from typing import Iterable, Optional, Union

import numpy
import rospy
from geometry_msgs.msg import Vector3

from hgrid_proximity import srv
from hgrid_proximity.batches import Batch, QueryBatchArrays, write_geometry
from hgrid_proximity.errors import NoAnswer, Refused
from hgrid_proximity.events import Events
from hgrid_proximity.fields import Field, FieldArrays
from hgrid_proximity.msg import AllowedPair, Obstacle, RobotChange, Shape, Verdict
from hgrid_proximity.paths import GuardedPath
from hgrid_proximity.service import LONGEST, Service
from hgrid_proximity.states import Edges, States
from hgrid_proximity.streams import DistanceArrays, PairArrays, as_arrays
from hgrid_proximity.values import UPRIGHT, as_point, as_pose, globs, numbers


class Answer:
    """The answer to a query: exactly one of `clear`, `hit` and `unknown` is True.

    clear: nothing is there; for query_nearest: nothing is within max_distance
    hit: `hits` lists the bodies (`rosmsg show -r hgrid_proximity/Hit`); their points are in the frame that
        `response.header` names; response.answer.truncated tells whether `limit` left out some of them
    unknown: nothing was hit, but something may be there unseen; treat the place as occupied; `summary` says why
    response: the whole response of the service
    """

    def __init__(self, response):
        answer = response.answer
        if not answer.success:
            raise Refused(answer.code.name, answer.code.text)
        self.response = response
        self.clear = answer.verdict == Verdict.CLEAR
        self.hit = answer.verdict == Verdict.HIT
        self.unknown = not self.clear and not self.hit
        self.hits, self.summary = answer.hits, answer.summary

    @property
    def names(self):
        """Names of the bodies that were hit, as a list."""
        return [hit.name for hit in self.hits]

    def __bool__(self):
        raise TypeError("an answer is neither true nor false; read .clear, .hit or .unknown")

    def __repr__(self):
        return f"<{self.summary}>"


class Proximity:
    """A running proximity node. Call rospy.init_node() first. Several threads may share an object.

    Each kind of query has a connection, which stays open until close(). All queries have these options:

    frame: frame of the coordinates; empty: the world frame
    stamp: time that the query is about [rospy.Time], from `response.world.history_begin` to the newest tick; None: now. The
        answer is about the last tick that is not later, and says so in `response.header.stamp` and `summary`.
    exact: True: measure the shapes of bodies; False: measure only the boxes of the shapes
    include, exclude: a glob over body names, or several of them: only bodies that match `include` and do not match
        `exclude` can be hit. A glob of `include` that matches no body is refused.
    limit: largest number of hits; 0: ~limits/max_hits, but 1 for query_nearest
    max_time: [s] time limit of the node for the query; 0: none. The client waits for `timeout + max_time`.
    as_body: name of a body. The query ignores this body and all bodies that it is allowed to touch.

    All queries throw:

    Refused: the node refuses the request
    NoAnswer: the node does not answer in time
    TypeError, ValueError: an argument has a wrong type, or not as many numbers as it must have
    rospy.ROSInterruptException: this program is shutting down
    """

    def __init__(self, node: str = "proximity", timeout: float = 5.0):
        """@param node  name of the node, in the namespace of this program unless it begins with a slash
        @param timeout  [s, wall time] how long to wait for an answer, for a message, or for a node that does not run yet
        """
        self._node, self._timeout = rospy.resolve_name(node).rstrip("/"), timeout
        self._services = {
            kind: Service(f"{self._node}/{name}", kind, timeout)
            for name, kind in (
                ("query_sphere", srv.QuerySphere),
                ("query_segment", srv.QuerySegment),
                ("query_box", srv.QueryBox),
                ("query_shape", srv.QueryShape),
                ("query_nearest", srv.QueryNearest),
                ("explain_pair", srv.ExplainPair),
                ("get_allowed", srv.GetAllowed),
                ("list_scenes", srv.ListScenes),
                ("query_batch", QueryBatchArrays),
                ("distance_field", FieldArrays),
                ("check_states", srv.CheckStates),
                ("check_edges", srv.CheckEdges),
            )
        }
        self._changes = {
            name: Service(f"{self._node}/{name}", service, timeout, repeat=False)
            for name, service in (
                ("apply_obstacles", srv.ApplyObstacles),
                ("apply_robots", srv.ApplyRobots),
                ("set_allowed", srv.SetAllowed),
                ("load_octomap", srv.LoadOctomap),
                ("clear_map", srv.ClearMap),
                ("save_scene", srv.SaveScene),
                ("load_scene", srv.LoadScene),
                ("guard", srv.Guard),
            )
        }

    def __enter__(self) -> Proximity:
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Closes all connections. The next call connects again."""
        for service in (*self._services.values(), *self._changes.values()):
            service.close()

    def query_sphere(self, center, radius: float = 0.0, **options) -> Answer:
        """Which bodies does this sphere touch? With radius 0 it is a point."""
        return self._query(srv.QuerySphere, srv.QuerySphereRequest(center=as_point("center", center), radius=radius), options)

    def query_segment(self, start, end, radius: float = 0.0, **options) -> Answer:
        """Which bodies does this segment, or the capsule of this radius around it, touch, in order along it?"""
        request = srv.QuerySegmentRequest(start=as_point("start", start), end=as_point("end", end), radius=radius)
        return self._query(srv.QuerySegment, request, options)

    def query_box(self, center, size, orientation=UPRIGHT, **options) -> Answer:
        """Which bodies does this box touch?

        @param size  full lengths of the sides
        @param orientation  quaternion x, y, z, w
        """
        place = as_pose(as_point("center", center), orientation)
        request = srv.QueryBoxRequest(pose=place, size=Vector3(*numbers("size", size, "xyz")))
        return self._query(srv.QueryBox, request, options)

    def query_shape(self, shape: Shape, **options) -> Answer:
        """Which bodies does this shape (hgrid_proximity/Shape) touch?"""
        return self._query(srv.QueryShape, srv.QueryShapeRequest(shape=shape), options)

    def query_nearest(self, point=None, body: str = "", max_distance: float = 0.0, **options) -> Answer:
        """Which bodies are nearest to a point or to a body? One by default; `limit` asks for more.

        A hit need not be a contact: `hits[0].distance` says how far away the nearest body is. Give the name of the body
        as `as_body` too, to leave out what it may touch, such as its neighbors at a joint.

        @param max_distance  [m] bodies that are farther away cannot be hit; 0: no limit
        """
        if (point is None) == (not body):
            raise ValueError("query_nearest needs either a point or a body")
        request = srv.QueryNearestRequest(body=body, max_distance=max_distance)
        if point is not None:
            request.point = as_point("point", point)
        return self._query(srv.QueryNearest, request, options)

    def explain_pair(self, first: str, second: str, contacts: int = 0, stamp: Optional[rospy.Time] = None):
        """Why is the pair reported or not? Returns the response of ~explain_pair; `explanation` is its sentence.

        @param contacts  largest number of contacts to list
        @param stamp  time that the question is about, as for a query; None: now
        """
        request = srv.ExplainPairRequest(first=first, second=second, contacts=contacts)
        if stamp is not None:
            request.header.stamp = stamp
        return _answered(self._services[srv.ExplainPair](request))

    def query_batch(
        self,
        spheres=None,
        segments=None,
        boxes=None,
        shapes: Iterable[Shape] = (),
        points=None,
        bodies: Union[str, Iterable[str]] = (),
        max_distance: float = 0.0,
        lease=None,
        keep: float = 0.0,
        **options,
    ) -> Batch:
        """Asks many questions about one state of the world in one request. The questions are numbered in the order of the
        arguments: first all spheres, then segments, boxes, shapes, points and bodies.

        @param spheres  (centers, radii) [m]: which bodies does each sphere touch?
        @param segments  (starts, ends, radii) [m]: which bodies does each segment touch?
        @param boxes  (centers, sizes) or (centers, sizes, orientations) [m]: which bodies does each box touch? Sizes are full
            lengths of the sides. Without orientations, the boxes are parallel to the axes of the frame.
        @param shapes  messages hgrid_proximity/Shape: which bodies does each shape touch?
        @param points  [m] which bodies are nearest to each point?
        @param bodies  names of bodies: which other bodies are nearest to each of them?
        @param max_distance  [m] for points and bodies: bodies that are farther away cannot be hit; 0: no limit
        @param lease  `response.lease` of an earlier answer: asks about the same state of the world; None: the newest
        @param keep  [s] how long the node should keep this state of the world for later requests, at most ~limits/lease_max
        @param options  the options of all queries, with two differences: `limit` is for each question, and 0 means 1;
            `max_time` is for all questions together, and 0 or more than 10 means 10 s

        Centers, starts, ends, sizes and points are arrays of the shape (n, 3). Orientations are quaternions x, y, z, w of
        the shape (n, 4). Radii are n numbers, or one number for all questions. Coordinates are in the frame `frame`.
        """
        request = QueryBatchArrays._request_class(shape=list(shapes), nearest_to_body=globs(bodies))
        write_geometry(request, spheres, segments, boxes, points)
        request.max_distance = max_distance
        _apply(request, **options)
        _ask_same_world(request, lease, keep)
        return Batch(self._services[QueryBatchArrays](request, 10.0))  # the longest time limit of this service

    def distance_field(
        self,
        corner,
        size,
        resolution: float,
        max_distance: float,
        orientation=UPRIGHT,
        gradients: bool = False,
        lease=None,
        keep: float = 0.0,
        frame: str = "",
        stamp: Optional[rospy.Time] = None,
        include: Union[str, Iterable[str]] = (),
        exclude: Union[str, Iterable[str]] = (),
        max_time: float = 0.0,
    ) -> Field:
        """Returns the signed distance of the nearest body at each point of a lattice.

        @param corner  [m] first point of the lattice, in the frame `frame`
        @param size  [m] lengths of the sides of the lattice
        @param resolution  [m] distance of neighboring points; a lattice has at most 1,000,000 points
        @param max_distance  [m] larger distances become max_distance, larger depths -max_distance
        @param orientation  quaternion x, y, z, w: orientation of the lattice in the frame `frame`
        @param gradients  True: also return the gradient of the distance at each point
        @param lease, keep  as for query_batch()
        @param frame, stamp, include, exclude  as for all queries
        @param max_time  [s] time limit; 0, or more than 10, means 10
        """
        request = FieldArrays._request_class(resolution=resolution, max_distance=max_distance, gradients=gradients)
        request.pose = as_pose(as_point("corner", corner), orientation)
        request.size = Vector3(*numbers("size", size, "xyz"))
        request.header.frame_id, request.max_time = frame, max_time
        request.include, request.exclude = globs(include), globs(exclude)
        if stamp is not None:
            request.header.stamp = stamp
        _ask_same_world(request, lease, keep)
        return Field(self._services[FieldArrays](request, 10.0))  # the longest time limit of this service

    def check_states(
        self,
        joint_names: Iterable[str],
        positions,
        max_clearance: float = 0.0,
        gradients: bool = False,
        contacts: bool = False,
        **options,
    ) -> States:
        """Would the robot touch anything if its joints stood at these positions?

        @param positions  [rad or m] array of n rows, one for each state, with one number for each joint
        @param max_clearance  [m] also measure how far the robot is from contact, up to this distance; 0: only verdicts
        @param gradients  True: also compute how each clearance changes with each joint
        @param contacts  True: also describe where each state that is hit is in contact

        Options of check_states() and check_edges():
            robot: name of the robot; otherwise the robot that has these joints
            group: name of a group of the SRDF: only contacts of what its joints move count
            base: geometry_msgs/Pose of the root link in the world frame; otherwise it is where tf says
            others: {"robot/joint": position} [rad or m] joints of other robots; their other joints are where tf says. Only
                their contacts with the checked robot are looked for
            ignore: globs over the names of bodies that are not checked
            lease: `response.lease` of an earlier answer, to ask the same state of the world
            keep: [s] how long the node should keep this state of the world for further requests, counted from this one
            max_time: [s] time limit, at most 10
        """
        joint_names = list(joint_names)
        rows = _rows("positions", positions, joint_names)
        request = srv.CheckStatesRequest(
            positions=rows, max_clearance=max_clearance, gradients=gradients, contacts=contacts
        )
        return States(self._check(srv.CheckStates, request, joint_names, **options))

    def check_edges(
        self, joint_names: Iterable[str], start, end, tolerance: float = 0.0, any_contact: bool = False, **options
    ) -> Edges:
        """Would the robot touch anything on the straight ways from these joint positions to those?

        Clear is proved for all positions on the way, not only for samples.

        @param start, end  [rad or m] arrays of n rows, one for each edge, with one number for each joint
        @param tolerance  [m] contacts are found to this accuracy; 0: 1 mm
        @param any_contact  True: any contact ends the search, which is faster; False: look for the first one
        @param options  see check_states()
        """
        joint_names = list(joint_names)
        request = srv.CheckEdgesRequest(tolerance=tolerance, any_contact=any_contact)
        request.start, request.end = _rows("start", start, joint_names), _rows("end", end, joint_names)
        return Edges(self._check(srv.CheckEdges, request, joint_names, **options))

    def guard(
        self, robot: str, joint_names: Iterable[str], positions, times, start: Optional[rospy.Time] = None
    ) -> GuardedPath:
        """Watches the path that a robot is about to follow, and answers whether it is free. The node checks the path again
        whenever the world changes; the topic ~conflicts has the results.

        @param positions  [rad or m] array of n rows, one for each point of the path, with one number for each joint
        @param times  [s] n numbers, ascending: time from the start to each point. If the first one is not 0, the robot moves
            from where it is now to the first point
        @param start  [ROS time] when the path starts; None: now
        @throws Refused  nothing was changed
        @throws ValueError  a row does not have one number for each joint
        """
        joint_names = list(joint_names)
        request = srv.GuardRequest(robot=robot, joint_names=joint_names)
        request.positions = _rows("positions", positions, joint_names)
        request.time_from_start = [rospy.Duration.from_sec(time) for time in times]
        if start is not None:
            request.start = start
        return GuardedPath(self._changes["guard"](request))

    def stop_guard(self, robot: str):
        """Stops watching all paths of a robot, also those of ~guard/topics. The next message on such a topic starts again.

        @throws Refused  there is no such robot
        """
        self._change("guard", srv.GuardRequest(robot=robot))

    def apply_obstacles(self, *changes: Obstacle, complete_set: bool = False, owner: str = "", max_time: float = 0.0):
        """Makes all changes in their order, or none of them. `hgrid_proximity.obstacles` has functions that make changes.

        After NoAnswer, the changes may or may not have been made. move() and attach() can be repeated. remove() and
        detach() are refused if they were made already, and add() if the obstacle was moved or attached since. Compare with
        ~bodies.

        @param complete_set  True: every obstacle of `owner` that this request does not add is removed, even if the request
            moves or attaches it. Give the same owner to each add().
        @param owner  owner whose obstacles complete_set removes; empty: the name of this node
        @param max_time  [s] how much longer than `timeout` to wait, for example for many large meshes
        @returns the response; `response.world` is the state of the world in the first tick with the changes
        @throws Refused  nothing was changed, unless the code is BUSY and the text says that the change was made;
            failed_index is the index of the refused change, also 0 if the whole request was
        """
        request = srv.ApplyObstaclesRequest(changes=list(changes), complete_set=complete_set, owner=owner)
        return self._change("apply_obstacles", request, max_time)

    def apply_robots(self, *changes: RobotChange, max_time: float = 0.0):
        """Makes all changes in their order, or none of them. `hgrid_proximity.robots` has functions that make changes.

        After NoAnswer, the changes may or may not have been made. All of them can be repeated except remove(), which is
        refused if it was made already.

        @param max_time  [s] how much longer than `timeout` to wait, for example for descriptions with many meshes
        @returns the response; `response.world` is the state of the world in the first tick with the changes,
            `response.uncovered` and `response.warnings` say what to look at
        @throws Refused  nothing was changed, unless the code is BUSY and the text says that the change was made;
            failed_index is the index of the refused change, also 0 if the whole request was
        """
        return self._change("apply_robots", srv.ApplyRobotsRequest(changes=list(changes)), max_time)

    def set_allowed(self, *rules: AllowedPair, remove: bool = False, force: bool = False, max_time: float = 0.0):
        """Adds rules of which pairs may touch, in their order, or removes them: all of them or none.
        `hgrid_proximity.rules` has functions that make rules.

        After NoAnswer, the change may or may not have been made; it can be repeated.

        @param remove  True: remove the rules with the same `first` and `second`, in either order
        @param force  must be True if no pair could be reported any more
        @param max_time  [s] how much longer than `timeout` to wait, for example for thousands of rules
        @returns the response; `response.pairs_changed` is the number of pairs that were switched off or on again
        @throws Refused  nothing was changed, unless the code is BUSY and the text says that the change was made
        """
        return self._change("set_allowed", srv.SetAllowedRequest(rules=list(rules), remove=remove, force=force), max_time)

    def get_allowed(
        self, first: str = "", second: str = "", rules: bool = False, as_srdf: bool = False, limit: int = 0
    ):
        """Returns the response of ~get_allowed: `entries` lists the pairs about which a rule decides, with that rule.

        @param first, second  globs over names of bodies: only pairs of which one name matches `first` and the other one
            matches `second`; empty: all names
        @param rules  True: list the rules as they were given instead; the globs are compared with their texts
        @param as_srdf  True: `srdf` holds the pairs within one robot as SRDF text
        @param limit  largest number of entries; 0: ~limits/max_pairs. `total` counts all, `truncated` says whether some are missing
        @throws Refused  a glob is too long, or too many pairs would have to be examined
        """
        request = srv.GetAllowedRequest(first=first, second=second, rules=rules, as_srdf=as_srdf, limit=limit)
        return _answered(self._services[srv.GetAllowed](request))

    def load_octomap(
        self,
        file: str,
        map: str,
        position=(0.0, 0.0, 0.0),
        orientation=UPRIGHT,
        frame: str = "",
        max_time: float = 0.0,
    ):
        """Reads a file of the folder ~map/folder into a map. The old map of that name stays until the new one is ready.

        After NoAnswer, the map may or may not be there; load it again.

        @param file  name of the file, without a path, such as "floor.bt"
        @param map  name of the map without its source: "room" is the body "map/room"
        @param position, orientation  [m], quaternion x, y, z, w: pose of the origin of the map in `frame`
        @param frame  tf frame that the map follows; empty: the world frame
        @param max_time  [s] how much longer than `timeout` to wait, for example for a map of 100 MB
        @returns the response: `occupied_leaves`, `resolution` [m], `duration` [s]; `world` is the state of the world in the
            first tick with the map
        @throws Refused  nothing was changed
        """
        request = srv.LoadOctomapRequest(file=file, map=map, pose=as_pose(position, orientation))
        request.header.frame_id = frame
        return self._change("load_octomap", request, max_time)

    def clear_map(self, map: str):
        """Removes one map. Returns the response. @param map  name of the map; empty: all maps @throws Refused"""
        return self._change("clear_map", srv.ClearMapRequest(map=map))

    def save_scene(self, name: str, replace: bool = False, max_time: float = 0.0):
        """Saves all obstacles, attachments and lasting rules as `scenes/NAME.yaml` in ~state_folder.

        @param replace  True: replace a scene of this name; False: refuse the name if there is such a scene
        @param max_time  [s] how much longer than `timeout` to wait, for example for many large meshes
        @returns the response; `response.path` is the path of the file
        @throws Refused  nothing was written
        """
        return self._change("save_scene", srv.SaveSceneRequest(name=name, replace=replace), max_time)

    def load_scene(self, name: str, replace: bool = False, max_time: float = 0.0):
        """Loads a saved scene, all of it or nothing. Obstacles of the scene replace those of the same names.

        After NoAnswer, the scene may or may not be loaded; load it again.

        @param replace  True: remove all other obstacles and all other rules of ~set_allowed; False: keep them
        @param max_time  [s] how much longer than `timeout` to wait, for example for many large meshes
        @returns the response; `response.world` is the state of the world in the first tick with the changes
        @throws Refused  nothing was changed
        """
        return self._change("load_scene", srv.LoadSceneRequest(name=name, replace=replace), max_time)

    def list_scenes(self):
        """Returns the response of ~list_scenes: `names` lists the scenes in ~state_folder, sorted, and `saved` says for each
        of them when its file was last written [UTC]. `unusable` has a sentence for each file that load_scene() cannot load.

        @throws Refused  ~state_folder is not set, or it cannot be read
        """
        return _answered(self._services[srv.ListScenes](srv.ListScenesRequest()))

    def pairs(self) -> PairArrays:
        """Waits for the next message of ~pairs and returns it. Do not call this in a callback of ~pairs."""
        return self._next("pairs", PairArrays)

    def distances(self) -> DistanceArrays:
        """Waits for the next message of ~distances and returns it. To read many messages, subscribe instead."""
        return self._next("distances", DistanceArrays)

    def events(self) -> Events:
        """Listens to ~events from now on. Begin to listen before you do what causes the event:

            with proximity.events() as events:
                move()
                event = events.wait("robot/*", "obstacle/*", timeout=5.0)
        """
        return Events(self._node, self._timeout)

    def _next(self, stream: str, kind):
        topic = f"{self._node}/{stream}"
        try:
            return as_arrays(kind, rospy.wait_for_message(topic, kind, self._timeout))
        except rospy.ROSInterruptException:
            raise
        except rospy.ROSException as error:
            text = f"{topic}: no message within {self._timeout:g} s. Check the node: `rosnode ping {self._node}`"
            raise NoAnswer(text) from error

    def _check(
        self,
        kind,
        request,
        joint_names: Iterable[str],
        robot: str = "",
        group: str = "",
        base=None,
        others=None,
        ignore: Union[str, Iterable[str]] = (),
        lease=None,
        keep: float = 0.0,
        max_time: float = 0.0,
    ):
        request.robot, request.group, request.joint_names = robot, group, joint_names
        others = others or {}
        request.other_joint_names, request.other_positions = list(others), list(others.values())
        request.ignore, request.max_time, request.use_base = globs(ignore), max_time, base is not None
        if base is not None:
            request.base = base
        _ask_same_world(request, lease, keep)
        return self._services[kind](request, 10.0)  # the longest time limit of these services

    def _change(self, service: str, request, max_time: float = 0.0):
        return _answered(self._changes[service](request, min(max_time, LONGEST)))

    def _query(self, kind, request, options) -> Answer:
        _apply(request, **options)
        extra = min(request.max_time, LONGEST) if request.max_time > 0.0 else 0.0  # [s] max_time may be infinite
        return Answer(self._services[kind](request, extra))


def _answered(response):
    """Returns the response. @throws Refused if it is a refusal"""
    if not response.success:
        raise Refused(response.code.name, response.code.text, getattr(response, "failed_index", None))
    return response


def _ask_same_world(request, lease, keep: float):
    """Writes which state of the world a request asks about, and how long [s] the node should keep it."""
    if lease is not None:
        request.lease.epoch, request.lease.sequence = lease.epoch, lease.sequence
    request.lease.lasts = rospy.Duration.from_sec(keep)


def _rows(name: str, values, joint_names):
    """Returns an array of rows as a flat list. @throws ValueError if a row does not have one number for each joint"""
    rows = numpy.asarray(values, numpy.float64)
    if rows.ndim != 2 or rows.shape[1] != len(joint_names):
        shape = " x ".join(str(length) for length in rows.shape)
        raise ValueError(f"{name} has {shape} numbers; it must be rows with one number for each of {len(joint_names)} joints")
    return rows.ravel().tolist()


def _apply(
    request,
    frame: str = "",
    stamp: Optional[rospy.Time] = None,
    exact: bool = False,
    include: Union[str, Iterable[str]] = (),
    exclude: Union[str, Iterable[str]] = (),
    limit: int = 0,
    max_time: float = 0.0,
    as_body: str = "",
):
    """Writes the options of a query into its request."""
    request.header.frame_id = frame
    if stamp is not None:
        request.header.stamp = stamp
    request.exact, request.limit, request.max_time = exact, limit, max_time
    request.include, request.exclude = globs(include), globs(exclude)
    request.as_body, request.respect_allowed = as_body, bool(as_body)
