#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Parameters that change while a node runs, with the client and the program of dynamic_reconfigure. The node has two
obstacles that are 0.3 m apart."""
import subprocess
import threading
import time
import unittest

import rospy
import rosunit
from dynamic_reconfigure.client import Client
from hgrid_proximity.msg import Distances, Pairs, Status
from hgrid_proximity.srv import QuerySphere

FAR, NEAR = 0.1, 0.5  # [m] margins without and with the pair


class Reconfigure(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("reconfigure_test")
        cls.news = threading.Condition()
        cls.pairs, cls.distances, cls.status = [], [], []
        for name, kind, heard in (("pairs", Pairs, cls.pairs), ("distances", Distances, cls.distances),
                                  ("status", Status, cls.status)):
            rospy.Subscriber("/proximity/" + name, kind, cls.hear, heard, queue_size=100)
        cls.client = Client("proximity", timeout=60.0)
        cls.wait("a complete world", lambda: cls.pairs and cls.pairs[-1].world.complete)

    @classmethod
    def hear(cls, message, heard):
        with cls.news:
            heard.append(message)
            cls.news.notify_all()

    @classmethod
    def wait(cls, what, holds):
        with cls.news:
            if not cls.news.wait_for(holds, timeout=60.0):
                raise AssertionError("not seen after 60 s: " + what)

    def setUp(self):
        self.client.update_configuration({"margin": FAR, "distances/max": 0.0, "query_threads": 8})
        del self.pairs[:]
        self.wait("a tick", lambda: self.pairs)

    def counter(self, name):
        return {counter.name: counter.value for counter in self.status[-1].counters}.get(name, 0)

    def test_a_change_is_in_one_tick_with_its_hash(self):
        """Claim: each tick has all new values and another hash, or none of them. The parameter server has them, too."""
        before = self.pairs[-1].world.config_hash
        answer = self.client.update_configuration({"margin": NEAR, "distances/max": 0.4, "horizon": 0})
        self.assertEqual((answer["margin"], answer["distances/max"]), (NEAR, 0.4))
        self.wait("the pair", lambda: self.pairs[-1].gap)
        for message in self.pairs:
            self.assertEqual(len(message.gap) == 1, message.world.config_hash != before)
        self.wait("its distance", lambda: self.distances and self.distances[-1].gap)
        self.assertEqual(rospy.get_param("/proximity/margin"), NEAR)
        self.assertEqual(rospy.get_param("/proximity/distances/max"), 0.4)
        self.client.update_configuration({"distances/max": 0.2})
        self.wait("no distance up to 0.2 m", lambda: not self.distances[-1].gap)

    def test_a_wrong_change_is_refused_as_a_whole(self):
        """Claim: a value or a combination that is not allowed changes nothing, also no other value of the request."""
        before = self.pairs[-1].world.config_hash
        refused = self.counter("set_parameters.refused.OUT_OF_RANGE")
        in_force = self.client.get_configuration()
        wrong = [{"margin": NEAR, "distances/max": 0.6}, {"margin": -1.0}, {"horizon": 1.0, "query_threads": 65}]
        for change in wrong:
            answer = self.client.update_configuration(change)
            self.assertEqual({name: answer[name] for name in in_force if name != "groups"},
                             {name: in_force[name] for name in in_force if name != "groups"})
        self.wait("the refusals in ~status",
                  lambda: self.counter("set_parameters.refused.OUT_OF_RANGE") == refused + len(wrong))
        self.assertEqual({message.world.config_hash for message in self.pairs}, {before})
        self.assertEqual(rospy.get_param("/proximity/margin"), FAR)

    def test_dynparam_sets_and_prints_values(self):
        """Claim: the program dynparam works with the node."""
        run = ["rosrun", "dynamic_reconfigure", "dynparam"]
        subprocess.run(run + ["set", "/proximity", "margin", str(NEAR)], check=True, timeout=60)
        self.wait("the pair", lambda: self.pairs[-1].gap)
        shown = subprocess.run(run + ["get", "/proximity"], check=True, timeout=60, stdout=subprocess.PIPE)
        self.assertIn("'margin': %s" % NEAR, shown.stdout.decode())

    def test_queries_are_answered_while_their_threads_change(self):
        """Claim: no query is lost while the number of query threads changes."""
        query = rospy.ServiceProxy("/proximity/query_sphere", QuerySphere)
        asked, wrong, stop = [0], [], threading.Event()

        def ask():
            while not stop.is_set():
                answer = query(radius=0.05).answer
                asked[0] += 1
                if not answer.success or len(answer.hits) != 1:
                    wrong.append(answer)

        thread = threading.Thread(target=ask)
        thread.start()
        try:
            for threads in (1, 16, 2, 8):
                seen = asked[0]
                self.client.update_configuration({"query_threads": threads})
                deadline = time.monotonic() + 60.0
                while asked[0] < seen + 10 and time.monotonic() < deadline:
                    self.wait("a tick", lambda count=len(self.pairs): len(self.pairs) > count)
        finally:
            stop.set()
            thread.join()
        self.assertEqual(wrong, [])
        self.assertGreaterEqual(asked[0], 40)

    def test_zz_the_audit_has_found_no_difference(self):
        """Claim: the audit, which computes ticks again by brute force, uses the values of the tick that it audits.

        The name puts it behind the other tests."""
        checked = self.counter("audit.checked")
        for margin in (NEAR, FAR, NEAR):
            self.client.update_configuration({"margin": margin})
            checked += 2
            self.wait("more audits", lambda: self.counter("audit.checked") >= checked)
        self.assertEqual(self.counter("audit.different"), 0)


if __name__ == "__main__":
    rosunit.unitrun("hgrid_proximity", "reconfigure", Reconfigure)
