#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Four clients change obstacles at once, at random. After each request, ~pairs must be what brute force finds."""
import itertools
import math
import pathlib
import random
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).with_name("support")))

import rospy  # noqa: E402  (needs the path above)
from cell import HAND, NAME, POST_PLACE, Failure, expect  # noqa: E402
from chaos import Deadline, calm_after, main  # noqa: E402
from hgrid_proximity import obstacles  # noqa: E402
from hgrid_proximity.client import Proximity  # noqa: E402
from hgrid_proximity.errors import Refused  # noqa: E402
from hgrid_proximity.msg import Pairs  # noqa: E402

CLIENTS, NAMES = 4, 6
MARGIN = 0.1  # [m] default of ~margin
DOUBT = 1e-4  # [m] a pair is not judged if its gap is this near to the margin: the node computes in float
LINK = "robot/hand"


class Thing:
    """A sphere. `touch` is None, or, if it is attached to the hand, the names of bodies that it may touch."""

    def __init__(self, place, radius, moving=False, touch=None):
        self.place, self.radius, self.moving, self.touch = place, radius, moving, touch

    def moves(self):
        return self.moving or self.touch is not None

    def gap(self, other):
        """Returns the distance of the boxes around both spheres [m]."""
        reach = self.radius + other.radius
        return math.sqrt(sum(max(0.0, abs(a - b) - reach)**2 for a, b in zip(self.place, other.place)))


def may_touch(first, second, things):
    """Whether the pair is never reported."""
    one, other = things[first], things[second]
    if not one.moves() and not other.moves():
        return True
    return (one.touch is not None and second in (LINK, *one.touch)) or (
        other.touch is not None and first in (LINK, *other.touch))


def brute_force(things):
    """Returns two sets of pairs of names: those that must be reported, and those that may be."""
    must, may = set(), set()
    for first, second in itertools.combinations(sorted(things), 2):
        gap = things[first].gap(things[second])
        if may_touch(first, second, things) or gap > MARGIN + DOUBT:
            continue
        (must if gap < MARGIN - DOUBT else may).add((first, second))
    return must, may


class Heard:
    """The newest message of ~pairs."""

    def __init__(self):
        self._changed, self._message = threading.Condition(), None
        rospy.Subscriber(NAME + "/pairs", Pairs, self._on_pairs, queue_size=10)

    def _on_pairs(self, message):
        with self._changed:
            self._message = message
            self._changed.notify_all()

    def since(self, sequence):
        """Waits for a message of this tick or a later one. Returns its pairs of names."""
        end = time.monotonic() + 20.0
        with self._changed:
            while self._message is None or self._message.world.sequence < sequence:
                if not self._changed.wait(end - time.monotonic()):
                    raise Failure("no ~pairs of tick %d or later arrived within 20 s" % sequence)
            message = self._message
        return {(message.names[a], message.names[b]) for a, b in zip(message.first, message.second)}


class Client:
    """Changes its own obstacles until the deadline. Stores in `wrong` what was not as expected."""

    def __init__(self, number, seed, heard):
        self.owner = "client%d" % number
        self.names = ["%s_%d" % (self.owner, i) for i in range(NAMES)]
        self.rng, self.heard = random.Random(seed), heard
        self.things = {}  # by local name
        self.counts = {"applied": 0, "refused": 0, "changes": 0}
        self.wrong = None
        self.proximity = Proximity(NAME)

    def run_until(self, deadline):
        try:
            while deadline:
                self.step()
        except Exception as error:  # the main thread reports it
            self.wrong = "%s: %s: %s" % (self.owner, type(error).__name__, error)

    def bodies(self):
        """Returns the obstacles, by full name."""
        return {"obstacle/" + name: thing for name, thing in self.things.items()}

    def step(self):
        """Sends one request with random changes, and checks its answer and the pairs of the obstacles."""
        after, added, request, refusal = dict(self.things), set(), [], None
        for index in range(self.rng.randint(1, 5)):
            change, code = self.random_change(after, added)
            request.append(change)
            if code and not refusal:
                refusal = (code, index)
        complete = self.rng.random() < 0.05
        if complete:
            after = {name: thing for name, thing in after.items() if name in added}
        self.counts["changes"] += len(request)
        try:
            answer = self.proximity.apply_obstacles(*request, complete_set=complete, owner=self.owner)
        except Refused as refused:
            expect("refusal of %s" % request, refusal, (refused.code, refused.failed_index))
            self.counts["refused"] += 1
            return
        expect("refusal of %s" % request, refusal, None)
        self.counts["applied"] += 1
        self.things = after
        compare("the obstacles of " + self.owner, {LINK: hand(), **self.bodies()}, self.heard.since(answer.world.sequence))

    def random_change(self, after, added):
        """Returns a random change, and the code with which the node must refuse it. Makes the change in `after`."""
        rng, name = self.rng, self.rng.choice(self.names)
        old, place = after.get(name), tuple(a + rng.uniform(-0.4, 0.4) for a in HAND)
        attached = old is not None and old.touch is not None
        kinds = ("remove", "attach", "detach") if attached else ("add", "move", "move", "remove", "attach", "attach")
        if rng.random() < 0.05:  # one of the changes that the node must refuse, among others
            kinds = ("add", "move", "remove", "attach", "detach")
        elif old is None:
            kinds = ("add",)
        kind = rng.choice(kinds)
        if kind == "add":
            thing = Thing(place, rng.uniform(0.02, 0.1), moving=rng.random() < 0.3)
            replace = rng.random() < 0.95
            if old is None or replace:
                after[name] = thing
                added.add(name)
            change = obstacles.add(name, obstacles.sphere(thing.radius), position=place, replace=replace,
                                   moving=thing.moving, owner=self.owner)
            return change, "DUP_ID" if old and not replace else None
        touch = ["obstacle/post"] if rng.random() < 0.3 else []
        change = {
            "move": lambda: obstacles.move(name, position=place),
            "remove": lambda: obstacles.remove(name),
            "attach": lambda: obstacles.attach(name, LINK, [a - b for a, b in zip(place, HAND)], touch=touch),
            "detach": lambda: obstacles.detach(name),
        }[kind]()
        if old is None:
            return change, "UNKNOWN_ID"
        if kind == "remove":
            del after[name]
        elif kind == "attach":
            after[name] = Thing(place, old.radius, old.moving, touch)
        elif attached == (kind == "move"):
            return change, "CONFLICT"
        else:
            after[name] = Thing(place if kind == "move" else old.place, old.radius, old.moving)
        return change, None


def hand():
    return Thing(HAND, 0.1, moving=True)


def compare(what, things, seen):
    """Checks that the pairs of these bodies are what brute force finds. Returns the number of pairs."""
    must, may = brute_force(things)
    seen = {pair for pair in seen if pair[0] in things and pair[1] in things}
    expect("pairs of " + what, sorted(must), sorted(seen), must <= seen <= must | may)
    return len(must)


def changes(cell, rng, seconds):
    cell.begin()
    heard = Heard()
    clients = [Client(i, rng.random(), heard) for i in range(CLIENTS)]
    rounds = max(2, int(seconds / 5))
    found = []
    with calm_after(cell):
        for _ in range(rounds):
            deadline = Deadline(seconds / rounds)
            threads = [threading.Thread(target=client.run_until, args=(deadline,), daemon=True) for client in clients]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            for client in clients:
                if client.wrong:
                    raise Failure(client.wrong)
            things = {LINK: hand(), "obstacle/post": Thing(POST_PLACE, 0.1)}
            for client in clients:
                things.update(client.bodies())
            found.append(compare("all bodies", things, heard.since(cell.status().world.sequence + 1)))
        for client in clients:
            client.proximity.apply_obstacles(complete_set=True, owner=client.owner)
    total = {name: sum(client.counts[name] for client in clients) for name in clients[0].counts}
    print("requests of %d clients: %s; pairs of all bodies between the rounds: %s" % (CLIENTS, total, found))


if __name__ == "__main__":
    main(changes)
