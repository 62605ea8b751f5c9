# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Listens to many topics in parallel for some time, and stores what the facts need."""
from __future__ import annotations

import itertools
import threading
import time
from typing import Callable, Dict, List, Tuple

from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from tf2_msgs.msg import TFMessage

from hgrid_doctor.facts import Facts, JointValue, TfStream, TopicFacts
from hgrid_doctor.observe.bounded import sentence_of
from hgrid_doctor.observe.connection import Connection, header_frame

MOST_OFFSETS = 500  # longest list of offsets of a stream
MOST_POSES = 100


class Listener:
    """Listens with one thread for each publisher of each topic. After finish(), nothing is written to the facts."""

    def __init__(self, facts: Facts, listen: float, timeout: float):
        """
        @param listen  [s] how long to listen
        @param timeout  [s] time limit for connecting; also how much longer to wait for the first ~status
        """
        self._facts, self._timeout = facts, timeout
        self._deadline = time.monotonic() + listen
        self._lock = threading.Lock()
        self._finished = False
        self._threads: List[threading.Thread] = []
        self._streams: Dict[Tuple[str, str, str, bool], TfStream] = {}
        self._newest_clock = None  # [s] newest time on /clock
        self._status_threads: List[threading.Thread] = []

    def clock(self, topic: str = "/clock"):
        self._start(topic, Clock, self._take_clock)

    def transforms(self, topic: str, static: bool):
        self._start(topic, TFMessage, lambda publisher, message: self._take_transforms(publisher, message, static))

    def joint_states(self, topic: str):
        joints = self._facts.joints.setdefault(topic, {})
        numbers = itertools.count()

        def take(_, message):
            number = next(numbers)
            for joint, position in itertools.zip_longest(message.name, message.position[: len(message.name)]):
                joints[joint] = JointValue(float("nan") if position is None else position, number)

        self._start(topic, JointState, take)

    def status(self, topic: str, host: str, kind):
        """@param kind  the message class of ~status"""
        before = len(self._threads)
        self._start(topic, kind, lambda _, message: self._take_status(message), host, self._timeout)
        self._status_threads = self._threads[before:]

    def frame_of(self, topic: str):
        """Reads only the begin of one message of the topic, because maps and clouds are large."""
        self._start(topic, None, None)

    def finish(self):
        """Waits until listening is over."""
        for thread in self._threads:
            thread.join(max(0.0, self._deadline + 0.2 - time.monotonic()))
        # On a busy machine the node may need longer than usual for its first message.
        while self._facts.status is None and any(thread.is_alive() for thread in self._status_threads):
            time.sleep(0.05)
        with self._lock:
            self._finished = True
        self._facts.streams = list(self._streams.values())
        self._facts.wall = time.time()

    def _start(self, topic: str, kind, take: Callable, only: str = "", longer: float = 0.0):
        """Starts a thread for each publisher of the topic.

        @param only  listens only to this publisher; empty: to all
        @param longer  [s] how much longer than the others to listen
        """
        self._facts.topics[topic] = TopicFacts()
        for publisher in self._facts.alive_publishers(topic):
            node = self._facts.nodes.get(publisher)
            if node is None or not node.uri or (only and publisher != only):
                continue
            thread = threading.Thread(target=self._read, args=(topic, node, kind, take, self._deadline + longer), daemon=True)
            thread.start()
            self._threads.append(thread)

    def _read(self, topic, node, kind, take, deadline):
        facts = self._facts.topics[topic]
        try:
            connection = Connection(topic, node.uri, deadline, self._timeout)
            try:
                facts.types[node.name] = connection.header.get("type", "")
                if kind is None:
                    self._peek(connection, node.name, facts)
                else:
                    self._check_type(connection.header, kind)
                    self._read_all(connection, node.name, facts, kind, take)
            finally:
                connection.close()
        except Exception as error:  # an unusual publisher must not end the diagnosis
            facts.errors[node.name] = sentence_of(error)

    @staticmethod
    def _check_type(header, kind):
        if header.get("md5sum") != kind._md5sum:
            raise OSError(f"it sends {header.get('type')} with md5sum {header.get('md5sum')}, not {kind._md5sum}")

    def _peek(self, connection, publisher, facts):
        begin = connection.first_bytes(4 + 16 + 256)
        if begin:
            facts.counts[publisher] = 1
            if facts.types[publisher] == "visualization_msgs/MarkerArray":
                begin = begin[4:]  # the number of markers comes before the header of the first one
            facts.frames[publisher] = header_frame(begin).lstrip("/")

    def _read_all(self, connection, publisher, facts, kind, take):
        for data in connection.messages():
            message = kind()
            message.deserialize(data)
            with self._lock:
                if self._finished:
                    return
                facts.counts[publisher] = facts.counts.get(publisher, 0) + 1
                take(publisher, message)

    def _take_clock(self, _, message):
        self._newest_clock = message.clock.to_sec()
        self._facts.clock.append(self._newest_clock)

    def _take_status(self, message):
        if self._facts.first_status is None:
            self._facts.first_status = message
        self._facts.status = message

    def _now(self):
        """Returns the ROS time [s]; None before the first message of /clock."""
        return self._newest_clock if self._facts.graph.use_sim_time else time.time()

    def _take_transforms(self, publisher, message, static):
        now = self._now()
        for transform in message.transforms:
            parent, child = transform.header.frame_id.lstrip("/"), transform.child_frame_id.lstrip("/")
            key = (publisher, parent, child, static)
            stream = self._streams.setdefault(key, TfStream(*key))
            stream.count += 1
            stamp = transform.header.stamp.to_sec()
            if stamp == 0.0 and not static:
                stream.zero_stamps += 1
            elif now is not None and len(stream.offsets) < MOST_OFFSETS:
                stream.offsets.append(stamp - now)
            if len(stream.poses) < MOST_POSES:
                t, q = transform.transform.translation, transform.transform.rotation
                stream.poses.append((stamp, (t.x, t.y, t.z, q.x, q.y, q.z, q.w)))
