# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""A service with a persistent connection and a time limit."""
from __future__ import annotations

import queue
import threading

import rospy

from hgrid_proximity.errors import NoAnswer


class Service:
    """Calls one service. Several threads may share an object; their calls run one after the other.

    The connection stays open between calls. After an error, the next call connects again.
    """

    def __init__(self, name: str, kind, timeout: float):
        """@param timeout  [s] longest time from a call to its answer, connecting included"""
        self._name, self._kind, self._timeout = name, kind, timeout
        self._lock = threading.Lock()
        self._line = None

    def __call__(self, request, extra: float = 0.0):
        """Returns the response. Throws NoAnswer.

        @param extra  [s] how much longer than usual the node may work on this request
        """
        with self._lock:
            if self._line is None:
                self._line = _Line(self._name, self._kind)
            limit = self._timeout + extra
            try:
                response, error = self._line.ask(request, limit)
            except queue.Empty:
                response, error = None, f"it did not answer within {limit:g} s"
            if error is None:
                return response
            self._close()
            raise NoAnswer(f"{self._name}: {error}. `rosnode list` shows whether the node runs.")

    def close(self):
        with self._lock:
            self._close()

    def _close(self):
        if self._line is not None:
            self._line.close()
            self._line = None


class _Line:
    """A connection with a thread of its own, because rospy cannot limit the time of a call.

    A caller that lost patience abandons the object: its thread ends when the connection does.
    """

    def __init__(self, name: str, kind):
        self._proxy = rospy.ServiceProxy(name, kind, persistent=True)
        self._requests, self._outcomes = queue.Queue(), queue.Queue()
        threading.Thread(target=self._work, daemon=True).start()

    def ask(self, request, limit: float):
        """Returns (response, None) or (None, error). Throws queue.Empty after `limit` seconds."""
        self._requests.put(request)
        return self._outcomes.get(timeout=limit)

    def close(self):
        """Ends the thread after the call in progress."""
        self._requests.put(None)

    def _work(self):
        while True:
            request = self._requests.get()
            if request is None:
                break
            try:
                self._outcomes.put((self._proxy(request), None))
            except Exception as error:  # rospy throws errors of many kinds; the caller must hear of each of them
                self._outcomes.put((None, str(error) or type(error).__name__))
        self._proxy.close()
