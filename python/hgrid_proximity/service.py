# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""A service with a time limit."""
from __future__ import annotations

import io
import queue
import threading
import time

import genpy
import rospy

from hgrid_proximity.errors import NoAnswer

LONGEST = 1e6  # [s] longest time limit
UNREACHABLE = "it cannot be reached"


class Service:
    """Calls one service.

    With `repeat`, the connection stays open between calls. Otherwise each call opens its own. Several threads may share an
    object. Their calls run one after the other, and the time limit of a call begins when the call before it has ended.
    """

    def __init__(self, name: str, kind, timeout: float, repeat: bool = True):
        """@param timeout  [s, wall time] longest time from a call to its answer, connecting included; 0 < timeout <= 1e6
        @param repeat  True: a call that fails on an open connection is made again; only for services that change nothing
        """
        if not 0.0 < timeout <= LONGEST:
            raise ValueError(f"timeout is {timeout!r} s; it must be greater than 0 and at most {LONGEST:g}")
        self._name, self._kind, self._timeout, self._repeat = name, kind, timeout, repeat
        self._lock = threading.Lock()
        self._line = None

    def __call__(self, request, extra: float = 0.0):
        """Returns the response.

        @param extra  [s] how much longer than usual the node may work on this request
        @throws NoAnswer  the next call connects again
        @throws TypeError  a field of the request has a wrong type
        @throws rospy.ROSInterruptException  this program is shutting down
        """
        try:
            request.serialize(io.BytesIO())
        except (genpy.SerializationError, AttributeError, TypeError) as error:
            raise TypeError(f"{self._name}: an argument has a wrong type: {error}") from error
        with self._lock:
            deadline = time.monotonic() + self._timeout + extra
            used = self._line is not None
            response, error = self._ask(request, deadline)
            if error and used and time.monotonic() < deadline:  # the node may have been restarted since the last call
                response, error = self._ask(request, deadline)
            if not self._repeat:
                self._close()
        if error:
            raise NoAnswer(f"{self._name}: {error}. Check the node: `rosnode ping {self._name.rpartition('/')[0]}`")
        return response

    def close(self):
        """Closes the connection, after the call in progress. The next call opens a new one."""
        with self._lock:
            self._close()

    def _ask(self, request, deadline: float):
        """Returns (response, None) or (None, error). Closes the connection unless there is a response."""
        if self._line is None:
            self._line = _Line(self._name, self._kind)
        try:
            response, error = self._line.ask(request, deadline)
        except BaseException:  # the answer may still come, but no later call must receive it
            self._close()
            raise
        if error:
            self._close()
        return response, error

    def _close(self):
        if self._line is not None:
            self._line.close()
            self._line = None


class _Line:
    """A connection with a thread of its own, because rospy cannot limit the time of a call.

    After a timeout, the caller closes this object and drops it. Its thread ends when the connection is closed.
    """

    def __init__(self, name: str, kind):
        self._name = name
        self._proxy = rospy.ServiceProxy(name, kind, persistent=True)
        self._requests, self._outcomes = queue.Queue(), queue.Queue()
        self._found = False
        threading.Thread(target=self._work, daemon=True).start()

    def ask(self, request, deadline: float):
        """Returns (response, None) or (None, error). @param deadline  [s] in time.monotonic()"""
        self._requests.put((request, deadline))
        while True:
            if rospy.is_shutdown():
                raise rospy.ROSInterruptException("rospy is shutting down")
            left = deadline - time.monotonic()
            if left <= 0.0:
                return None, "it did not answer in time" if self._found else UNREACHABLE
            try:
                return self._outcomes.get(timeout=min(left, 0.1))  # short, so that Ctrl-C ends the wait
            except queue.Empty:
                pass

    def close(self):
        """Closes the connection, and so ends the call in progress."""
        self._requests.put(None)
        try:
            self._proxy.close()
        except AttributeError:  # rospy 1.15 (Debian 11) closes a connection twice if the other end closed it, too
            pass

    def _work(self):
        while True:
            job = self._requests.get()
            if job is None:
                break
            try:
                self._find(job[1])
                self._outcomes.put((self._proxy(job[0]), None))
            except Exception as error:  # rospy throws errors of many kinds; the caller must hear of each of them
                self._outcomes.put((None, str(error) or type(error).__name__))
        self._proxy.close()

    def _find(self, deadline: float):
        """Waits until the service exists."""
        if self._found:
            return
        try:
            rospy.wait_for_service(self._name, max(0.01, deadline - time.monotonic()))
        except rospy.ROSException as error:
            raise rospy.ROSException(UNREACHABLE) from error
        self._found = True
