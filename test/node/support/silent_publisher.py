#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""A publisher that announces a message of 999,999,999 bytes but never sends the bytes.

usage: silent_publisher.py TOPIC TYPE MD5SUM
Prints "announced" for each subscriber that has received the announcement. Runs until it is killed.
"""
import socket
import struct
import sys
import threading
from xmlrpc.client import ServerProxy
from xmlrpc.server import SimpleXMLRPCServer

import rosgraph.rosenv

NAME = '/silent_publisher'
ANNOUNCED = 999999999  # bytes


def received(connection, count):
    data = b''
    while len(data) < count:
        data += connection.recv(count - len(data))
    return data


def serve(listener, type_name, md5sum):
    """Answers the connection header of each subscriber and announces the message. Never returns."""
    """Answers the connection header of each subscriber and announces the message."""
    kept = []
    while True:
        connection, _ = listener.accept()
        received(connection, struct.unpack('<I', received(connection, 4))[0])
        fields = ['callerid=' + NAME, 'type=' + type_name, 'md5sum=' + md5sum, 'latching=0']
        header = b''.join(struct.pack('<I', len(field)) + field.encode() for field in fields)
        connection.sendall(struct.pack('<I', len(header)) + header + struct.pack('<I', ANNOUNCED))
        kept.append(connection)
        print('announced', flush=True)


def main(topic, type_name, md5sum):
    listener = socket.create_server(('127.0.0.1', 0))
    threading.Thread(target=serve, args=(listener, type_name, md5sum), daemon=True).start()
    api = SimpleXMLRPCServer(('127.0.0.1', 0), logRequests=False, allow_none=True)
    there = ['TCPROS', '127.0.0.1', listener.getsockname()[1]]
    api.register_function(lambda caller, topic, protocols: (1, '', there), 'requestTopic')
    api.register_function(lambda *_: (1, '', 0), 'publisherUpdate')
    master = ServerProxy(rosgraph.rosenv.get_master_uri())
    code, message, _ = master.registerPublisher(NAME, topic, type_name, 'http://127.0.0.1:%d/' % api.server_address[1])
    if code != 1:
        sys.exit(message)
    api.serve_forever()


if __name__ == '__main__':
    main(*sys.argv[1:])
