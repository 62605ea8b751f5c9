#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""5,000 messages per second arrive on each of /tf, /tf_static, ~poses, a tracker, a cloud, a map and collision_object of MoveIt.
Counters account for all of them."""
import pathlib
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).with_name("support")))

from cell import AUDIT, POST, expect  # noqa: E402  (needs the path above)
from chaos import FLOW, calm_after, main  # noqa: E402

FLOOD = str(pathlib.Path(__file__).with_name("support") / "flood.py")
RATE = 5000.0  # [Hz] messages of each kind
KINDS = ("tf", "tf_static", "poses", "tracks", "cloud", "map", "collision_object")
# An obstacle that messages on ~poses move.
CART = {"name": "cart", "frame": "~poses", "shapes": [{"type": "sphere", "radius": 0.1}]}
PEOPLE = {"name": "people", "topic": "/people", "type": "poses", "shapes": [{"type": "sphere", "radius": 0.3}]}
GROWTH = 80.0 if AUDIT else 30.0  # [MB] the audit also stores messages of /tf (~limits/tf_queue_bytes)
# Beginnings of the counters of transforms. The node counts each transform in one of them, also those of ~poses.
DECIDED = ("poses.refused.", "tf.accepted", "tf.refused.", "tf.dropped.", "tf.ignored.", "tf.too_old", "tf.repeated", "tf.rival")
INPUTS = {  # topic -> beginnings of the names of the counters of its messages
    "/cloud": ("cloud/front.accepted", "cloud/front.refused."),
    "/octomap_binary": ("maps.accepted", "maps.refused."),
}


def total(counters, beginnings):
    return sum(value for name, value in counters.items() if name.startswith(beginnings))


def check_tf(cell, sent, earlier):
    """Waits until the node has counted all transforms. Each message contains one transform."""
    def counted():
        return total(cell.counters(), DECIDED) - earlier

    cell.wait("%d messages of tf to be counted; counted are %d" % (sent, counted()), lambda: counted() == sent)


def check_input(cell, topic, sent, earlier):
    """Checks that the node counts each message that it reads. roscpp counts messages that newer ones have replaced."""
    received, dropped = cell.received(topic)
    expect("messages that arrived on " + topic, sent, received)

    def counted():
        return total(cell.counters(), INPUTS[topic]) - earlier

    cell.wait("%d messages of %s to be counted, as %d arrived and roscpp dropped %d; counted are %d" % (
        received - dropped, topic, received, dropped, counted()), lambda: counted() == received - dropped)
    print("%s: of %d messages, %d were replaced before they were read" % (topic, received, dropped))


def check_queue(cell, what, sent, earlier):
    """Checks that the node has applied, refused or dropped each message. `what` is the beginning of the counters."""
    decided = tuple(what + end for end in ("applied", "refused.", "dropped."))

    def counted():
        return total(cell.counters(), decided) - total(earlier, decided)

    cell.wait("%d messages of %s to be counted; counted are %d" % (sent, what, counted()), lambda: counted() == sent)
    expect("received messages of " + what, sent, cell.counters()[what + "received"] - earlier.get(what + "received", 0))
    print("%s: %s" % (what, {name: value for name, value in cell.counters().items() if name.startswith(what)}))


def start_movers(cell):
    """Starts the processes that move the cart, and report the person, 50 times per second."""
    return [flood(cell, kind, 50, 1e6, -1) for kind in ("poses", "tracks")]


def flood(cell, kind, rate, seconds, seed):
    command = (sys.executable, FLOOD, kind, str(rate), str(seconds), str(seed))
    return cell.start(*command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)


def sent_by(process):
    """Waits until a flood is over. Returns the number of its messages."""
    return int(process.stdout.readline())


def storms(cell, rng, seconds):
    cell.start_all(moveit={"topics": True}, obstacles=[POST, CART], maps=[{"name": "room", "topic": "octomap_binary"}],
                   clouds=[{"name": "front", "topic": "cloud", "lifetime": 3600}], tracks=[PEOPLE])
    cell.wait("the first tick", cell.status)
    movers = start_movers(cell)
    first = [flood(cell, kind, 10, 1, 1) for kind in ("tf_static", "cloud", "map")]  # these messages complete the world
    for process in first:
        sent_by(process)
    cell.wait_until_right()
    for process in first:
        process.communicate()  # closes the input of the process, which ends it
    for process in (cell.hand, *movers):  # now the flood places the hand, the cart and the person
        process.kill()
        process.wait()
    earlier = cell.counters()
    with calm_after(cell, growth=GROWTH):
        begin, sequence = time.monotonic(), cell.status().world.sequence
        floods = {kind: flood(cell, kind, RATE, seconds, rng.randrange(1000)) for kind in KINDS}
        sent = {kind: sent_by(process) for kind, process in floods.items()}
        lasted = time.monotonic() - begin
        share = (cell.status().world.sequence - sequence) / (50.0 * lasted)
        print("sent in %.1f s: %s; %.0f %% of the ticks came" % (lasted, sent, 100 * share))
        expect("share of the ticks during the storm", "at least %g" % FLOW, "%.3f" % share, share >= FLOW)
        check_tf(cell, sent["tf"] + sent["tf_static"] + sent["poses"], total(earlier, DECIDED))
        check_queue(cell, "moveit.", sent["collision_object"], earlier)
        check_queue(cell, "track/people.", sent["tracks"], earlier)
        check_input(cell, "/cloud", sent["cloud"], total(earlier, INPUTS["/cloud"]))
        check_input(cell, "/octomap_binary", sent["map"], total(earlier, INPUTS["/octomap_binary"]))
        cell.hand = cell.start_puppet()
        start_movers(cell)


if __name__ == "__main__":
    main(storms)
