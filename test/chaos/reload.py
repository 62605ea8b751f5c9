#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The robot is reloaded 200 times while four clients send queries. Each answer is about one model, never a mixture."""
import pathlib
import sys
import threading

sys.path.insert(0, str(pathlib.Path(__file__).with_name("support")))

import rospy  # noqa: E402  (needs the path above)
from cell import HAND, NAME, Cell, expect, robot, sphere  # noqa: E402
from chaos import Deadline, calm_after, main  # noqa: E402
from hgrid_proximity.srv import ReloadRobot  # noqa: E402

RELOADS = 200
FIRST, SECOND = ("hand", "left"), ("hand", "right", "top")  # links of the two models; all are at the same place
MODELS = [{"robot/" + link for link in links} for links in (FIRST, SECOND)]


class Asker(threading.Thread):
    """A client that asks what is at the place of the hand. Stores the first answer that fits neither model."""

    def __init__(self):
        super().__init__(daemon=True)
        self.stopping, self.answers, self.wrong = False, 0, None

    def run(self):
        proxy = Cell.client()
        while not self.stopping and self.wrong is None:
            try:
                response = proxy(sphere(HAND))
            except rospy.ServiceException as error:
                self.wrong = str(error)
                return
            self.answers += 1
            hit = {each.name for each in response.answer.hits}
            if hit not in MODELS:
                self.wrong = "%s, %s" % (sorted(hit), response.answer.summary)


def reload(cell, rng, seconds):
    frames = sorted(set(FIRST + SECOND))
    cell.hand = cell.start_puppet(frames)
    cell.set("/robot_description", robot(*FIRST))
    cell.params()
    cell.node = cell.start_node()
    cell.wait_until_right()
    service = rospy.ServiceProxy(NAME + "/reload_robot", ReloadRobot, persistent=True)
    with calm_after(cell):
        askers = [Asker() for _ in range(4)]
        for asker in askers:
            asker.start()
        deadline, done = Deadline(seconds), 0
        while deadline and done < RELOADS and not any(asker.wrong for asker in askers):
            links = rng.choice((FIRST, SECOND))
            cell.set("/robot_description", robot(*links))
            response = service(robot="")
            expect("~reload_robot", "success", response.code.text, response.success)
            seen = {hit.name for hit in cell.ask(HAND).answer.hits}
            expect("bodies at the hand after the reload", sorted("robot/" + link for link in links), sorted(seen))
            done += 1
        for asker in askers:
            asker.stopping = True
        for asker in askers:
            asker.join()
        wrong = [asker.wrong for asker in askers if asker.wrong]
        expect("answers during reloads", "only of one model", wrong, not wrong)
        print("%d reloads, %d answers" % (done, sum(asker.answers for asker in askers)))


if __name__ == "__main__":
    main(reload)
