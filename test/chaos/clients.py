#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""64 clients call a service while others leave during a call and 900 connections are idle. Then md5 sums are wrong."""
import io
import pathlib
import resource
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).with_name("support")))

import rospy  # noqa: E402  (needs the path above)
import tcpros  # noqa: E402
from cell import HAND, NAME, Cell, expect, sphere  # noqa: E402
from chaos import FLOW, Deadline, calm_after, main  # noqa: E402
from hgrid_proximity.msg import Verdict  # noqa: E402
from hgrid_proximity.srv import QuerySphere  # noqa: E402
from std_msgs.msg import String  # noqa: E402

CLIENTS, IDLE = 64, 900
SERVICE = NAME + "/query_sphere"


class Client(threading.Thread):
    """Calls ~query_sphere until the deadline. Stores the duration of each call, and the first wrong answer."""

    def __init__(self, deadline):
        super().__init__(daemon=True)
        self.deadline, self.times, self.wrong = deadline, [], None

    def run(self):
        proxy, request = Cell.client(), sphere(HAND)
        while self.deadline and self.wrong is None:
            begin = time.monotonic()
            try:
                answer = proxy(request).answer
            except rospy.ServiceException as error:
                self.wrong = str(error)
                return
            self.times.append(time.monotonic() - begin)
            if answer.verdict != Verdict.HIT:
                self.wrong = answer.summary


def leave(place, call, rng):
    """Connects as a client, and closes the connection at a random point of the call."""
    connection = tcpros.connect(place)
    with connection:
        if rng.random() < 0.5:
            connection.sendall(call[:rng.randrange(len(call))])  # closes it within the header or within the request
        else:
            connection.sendall(call)  # closes it before or during the answer
            if rng.random() < 0.5:
                tcpros.answer(connection)


def check_wrong_md5(cell, place, uri):
    """Checks that the node refuses a client, a subscriber and a publisher with a wrong md5 sum."""
    with tcpros.connect(place) as connection:
        connection.sendall(tcpros.header(service=SERVICE, md5sum="0" * 32, callerid="/wrong", persistent="1"))
        said = tcpros.answer(connection)
        expect("answer to a client with a wrong md5 sum", "an error", said, b"error=" in said and b"md5sum" in said)
    topic = NAME + "/pairs"
    with tcpros.connect(tcpros.topic_place(uri, topic)) as connection:
        connection.sendall(tcpros.header(topic=topic, md5sum="0" * 32, callerid="/wrong", type="std_msgs/String"))
        said = tcpros.answer(connection)
        expect("answer to a subscriber with a wrong md5 sum", "an error", said, b"error=" in said and b"md5sum" in said)
    rospy.Publisher("/tf", String, queue_size=1)
    cell.wait("a line of the log about the publisher with a wrong md5 sum",
              lambda: "md5sum" in cell.output.read_text(errors="replace"))


def clients(cell, rng, seconds):
    cell.begin(query_threads=2)
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(4096, hard), hard))
    place = tcpros.service_place(cell.master, SERVICE)
    buffer = io.BytesIO()
    sphere(HAND).serialize(buffer)
    call = tcpros.header(service=SERVICE, md5sum=QuerySphere._md5sum, callerid="/leaving") + tcpros.framed(
        buffer.getvalue())
    with calm_after(cell):
        idle = [tcpros.connect(place) for _ in range(IDLE)]
        cell.wait_until_right()
        begin, first = time.monotonic(), cell.status().world.sequence
        deadline = Deadline(seconds)
        askers = [Client(deadline) for _ in range(CLIENTS)]
        for asker in askers:
            asker.start()
        left = 0
        while deadline:
            leave(place, call, rng)
            left += 1
            time.sleep(0.005)  # without a pause, this thread would slow down the clients
        for asker in askers:
            asker.join()
        ticks = (cell.status().world.sequence - first) / (time.monotonic() - begin)
        for connection in idle:
            connection.close()
        wrong = [asker.wrong for asker in askers if asker.wrong]
        expect("answers to %d clients" % CLIENTS, "all HIT", wrong[:3], not wrong)
        expect("clients with answers", CLIENTS, sum(1 for asker in askers if asker.times))
        expect("ticks per second", "at least %g of 50" % (50 * FLOW), "%.1f" % ticks, ticks >= 50 * FLOW)
        check_wrong_md5(cell, place, cell.master.lookupNode("/test", NAME)[2])
        times = sorted(each for asker in askers for each in asker.times)
        print("%d answers, p99 %.1f ms; %d clients left during a call; %.1f ticks per second" % (
            len(times), 1e3 * times[len(times) * 99 // 100], left, ticks))


if __name__ == "__main__":
    main(clients)
