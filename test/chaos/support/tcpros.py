# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Connections to a node by TCPROS, without a client library. A test can send any bytes over them."""
import socket
import struct
from urllib.parse import urlparse
from xmlrpc.client import ServerProxy

PATIENCE = 10.0  # [s] timeout of a connection


def framed(data):
    return struct.pack("<I", len(data)) + data


def header(**fields):
    """Returns the bytes of a connection header."""
    return framed(b"".join(framed(("%s=%s" % field).encode()) for field in fields.items()))


def received(connection, count):
    """Waits for exactly `count` bytes and returns them. Raises ConnectionError if the connection ends earlier."""
    data = b""
    while len(data) < count:
        part = connection.recv(count - len(data))
        if not part:
            raise ConnectionError("the node closed the connection after %d of %d bytes" % (len(data), count))
        data += part
    return data


def answer(connection):
    """Waits for a block: its length and its bytes. Returns the bytes. A connection header is such a block."""
    return received(connection, struct.unpack("<I", received(connection, 4))[0])


def connect(place, receive_buffer=None):
    connection = socket.socket()
    connection.settimeout(PATIENCE)
    if receive_buffer:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_buffer)
    connection.connect(place)
    return connection


def service_place(master, service):
    """Returns the address of a service, as a pair of host and port."""
    place = urlparse(master.lookupService("/test", service)[2])
    return place.hostname, place.port


def topic_place(node_uri, topic):
    """Returns the address at which a node publishes a topic."""
    code, text, place = ServerProxy(node_uri).requestTopic("/test", topic, [["TCPROS"]])
    if code != 1:
        raise ConnectionError(text)
    return place[1], place[2]
