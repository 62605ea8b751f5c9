# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Reads a topic from one publisher, or calls a service, over TCPROS. Does not register with the master.

The publisher treats this program as an ordinary subscriber. Every call has a timeout. Connections end with listening.
"""
from __future__ import annotations

import io
import socket
import struct
import time
from typing import Any, Dict, Iterator
from urllib.parse import urlparse

from hgrid_doctor.observe.graph import CALLER, Api

MOST_BYTES = 64 * 1024 * 1024  # longest message [bytes]; a longer message ends the connection
MOST_HEADER = 1024 * 1024  # longest connection header [bytes]


class Peer:
    """A TCPROS connection to another node. Its methods throw OSError."""

    def __init__(self, host: str, port: int, fields: Dict[str, str], deadline: float, timeout: float):
        """Connects and exchanges the headers. @param deadline  [s] end of the connection, in time.monotonic()"""
        self._deadline = deadline
        self._socket = socket.create_connection((host, port), timeout)
        try:
            self._send({"callerid": CALLER, **fields})
            self.header = _fields(self._receive(self._length(MOST_HEADER)))
            if "error" in self.header:
                raise OSError(self.header["error"])
        except Exception:
            self.close()
            raise

    def close(self):
        self._socket.close()

    def _send(self, fields: Dict[str, str]):
        encoded = [f"{name}={value}".encode() for name, value in fields.items()]
        body = b"".join(struct.pack("<I", len(field)) + field for field in encoded)
        self._socket.sendall(struct.pack("<I", len(body)) + body)

    def _length(self, most: int) -> int:
        length = struct.unpack("<I", self._receive(4))[0]
        if length > most:
            raise OSError(f"it announces {length} bytes, more than {most}")
        return length

    def _receive(self, count: int) -> bytes:
        parts = []
        while count > 0:
            self._socket.settimeout(max(0.001, self._deadline - time.monotonic()))
            part = self._socket.recv(min(count, 1 << 16))
            if not part:
                raise ConnectionError("the other node closed the connection")
            parts.append(part)
            count -= len(part)
        return b"".join(parts)


class Connection(Peer):
    """A connection to one publisher of one topic. Its methods throw OSError or ApiError."""

    def __init__(self, topic: str, publisher_uri: str, deadline: float, timeout: float):
        """Connects to the publisher. @param deadline  [s] end of listening, in time.monotonic()"""
        answer = Api(publisher_uri, timeout)("requestTopic", topic, [["TCPROS"]])
        if not answer or answer[0] != "TCPROS":
            raise OSError("it offers no TCPROS connection")
        fields = {"topic": topic, "type": "*", "md5sum": "*", "tcp_nodelay": "1"}
        super().__init__(answer[1], answer[2], fields, deadline, timeout)

    def messages(self) -> Iterator[bytes]:
        """Yields the bytes of each message until listening ends or the publisher closes the connection."""
        while True:
            try:
                yield self._receive(self._length(MOST_BYTES))
            except (socket.timeout, ConnectionError):
                return

    def first_bytes(self, most: int) -> bytes:
        """Returns the first bytes of the next message; empty if none arrives."""
        try:
            return self._receive(min(most, self._length(2**31)))
        except (socket.timeout, ConnectionError):
            return b""


class ServiceConnection(Peer):
    """A connection to a service, for many calls. Its methods throw OSError."""

    def __init__(self, service: str, kind: Any, uri: str, timeout: float):
        """@param kind  the class of the service
        @param uri  "rosrpc://host:port", from the master"""
        self._kind, self._timeout = kind, timeout
        place = urlparse(uri)
        fields = {"service": service, "md5sum": kind._md5sum, "persistent": "1"}
        super().__init__(place.hostname or "", place.port or 0, fields, time.monotonic() + timeout, timeout)

    def call(self, request: Any) -> Any:
        self._deadline = time.monotonic() + self._timeout
        buffer = io.BytesIO()
        request.serialize(buffer)
        body = buffer.getvalue()
        self._socket.sendall(struct.pack("<I", len(body)) + body)
        succeeded = self._receive(1) == b"\x01"
        answer = self._receive(self._length(MOST_BYTES))
        if not succeeded:
            raise OSError(answer.decode("utf-8", "replace"))
        response = self._kind._response_class()
        response.deserialize(answer)
        return response


def _fields(header: bytes) -> Dict[str, str]:
    fields, place = {}, 0
    while place + 4 <= len(header):
        length = struct.unpack_from("<I", header, place)[0]
        name, _, value = header[place + 4 : place + 4 + length].partition(b"=")
        fields[name.decode("utf-8", "replace")] = value.decode("utf-8", "replace")
        place += 4 + length
    return fields


def header_frame(message: bytes) -> str:
    """Returns the frame_id of a message that begins with a std_msgs/Header."""
    if len(message) < 16:
        return ""
    length = struct.unpack_from("<I", message, 12)[0]
    return message[16 : 16 + min(length, 256)].decode("utf-8", "replace")
