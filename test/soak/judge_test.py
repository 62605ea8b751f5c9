#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The judge of the soak test finds each kind of drift, and none in a run without drift. Needs no ROS."""
import importlib.machinery
import importlib.util
import pathlib
import unittest

LOADER = importlib.machinery.SourceFileLoader("judge", str(pathlib.Path(__file__).with_name("judge")))
judge = importlib.util.module_from_spec(importlib.util.spec_from_loader("judge", LOADER))
LOADER.exec_module(judge)


def table(**changes):
    """Returns a table without drift. `changes` replaces columns: by one value for all tenths, or by a list of ten."""
    columns = {
        "tenth": list(range(1, 11)),
        "ticks": 18000,
        "missed": 0,
        "incomplete": 0,
        "tick_p50": 1.0,
        "tick_p99": 4.0,
        "query_p50": 0.5,
        "query_p99": 2.0,
        "failed": 0,
        "rss": [90.0] + [100.0] * 9,
        "maps": [180 * tenth for tenth in range(1, 11)],
        "used": [180 * tenth - 1 for tenth in range(1, 11)],
        "refusals": 0,
        "audited": 5,
        "different": 0,
        "cpu": 30,
        "others": 5,
    }
    columns.update(changes)
    lists = [value if isinstance(value, list) else [value] * 10 for value in columns.values()]
    rows = [" ".join(str(value) for value in row) for row in zip(*lists)]
    return "\n".join(["# a comment", " ".join(columns)] + rows).splitlines()


class Judge(unittest.TestCase):
    def assert_finds(self, words, **changes):
        found = judge.faults(judge.read(table(**changes)))
        self.assertEqual(1, len(found), found)
        self.assertIn(words, found[0])

    def test_finds_nothing_in_a_run_without_drift(self):
        self.assertEqual([], judge.faults(judge.read(table())))
        self.assertEqual([], judge.faults(judge.read(table(audited="-", different="-"))))

    def test_finds_memory_that_grows(self):
        grown = [100.0 + 0.4 * tenth for tenth in range(10)]
        self.assert_finds("growth of the memory (early: 100.8 MB): 2.4 MB", rss=grown)

    def test_finds_times_that_grow(self):
        for column in ("tick_p50", "tick_p99", "query_p50", "query_p99", "cpu"):
            self.assert_finds("late " + column, **{column: [4.0 + 0.9 * tenth for tenth in range(10)]})

    def test_blames_the_node_for_no_delay_by_other_programs(self):
        busy = {"others": [5] * 9 + [150], "missed": 2000}
        self.assertEqual([], judge.faults(judge.read(table(tick_p99=[4.0] * 6 + [40.0] * 4, **busy))))
        self.assert_finds("late tick_p50", tick_p50=[4.0] * 6 + [40.0] * 4, **busy)

    def test_forgives_one_disturbed_tenth(self):
        self.assertEqual([], judge.faults(judge.read(table(tick_p99=[4.0] * 8 + [40.0, 4.0]))))

    def test_finds_each_count_that_must_stay_zero(self):
        self.assert_finds("incomplete world", incomplete=[0] * 9 + [1])
        self.assert_finds("queries without an answer", failed=[0] * 9 + [1])
        self.assert_finds("refused, failed or dropped", refusals=[0] * 9 + [1])
        self.assert_finds("audit found other pairs", different=[0] * 9 + [1])

    def test_finds_missed_ticks_and_maps(self):
        self.assert_finds("missed ticks", missed=[2000] + [0] * 9)
        self.assert_finds("maps that were not used", used=0)

    def test_finds_a_table_that_ends_early(self):
        self.assertIn("5 tenths", judge.faults(judge.read(table()[:7]))[0])
        with self.assertRaises(ValueError):
            judge.read(["# only a comment"])


if __name__ == "__main__":
    unittest.main()
