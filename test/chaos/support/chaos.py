# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Runs one chaos test as a program. Checks after the faults that the node works as before."""
import argparse
import contextlib
import inspect
import pathlib
import random
import signal
import sys
import time
import traceback

from cell import AUDIT, Cell, Failure, expect, resident

PATIENCE = 180  # [s] a test has failed if it takes this much longer than its faults
FLOW = 0.5  # least share of the ticks during the faults; below 1, because other programs use the processors too
GROWTH = 8.0  # [MB] the memory of the node may grow by at most this during the faults


class Deadline:
    """Is true until some seconds have passed."""

    def __init__(self, seconds):
        self._end = time.monotonic() + seconds

    def __bool__(self):
        return time.monotonic() < self._end


@contextlib.contextmanager
def calm_after(cell, growth=GROWTH):
    """A context in which a test causes faults.

    At its end, the node must give right answers, and its memory may be at most `growth` [MB] larger than before."""
    before, pid = resident(cell.node.pid), cell.node.pid
    cell.take()
    yield
    heard = cell.take()
    expect("the node after the chaos", "alive", cell.node.poll(), cell.node.poll() is None and cell.node.pid == pid)
    cell.wait_until_right()
    cell.wait("memory of at most %.1f + %.1f MB; it is %.1f MB" % (before, growth, resident(pid)),
              lambda: resident(pid) <= before + growth)
    check_audit(cell)
    print("memory before and after: %.1f MB, %.1f MB" % (before, resident(pid)))
    print_ticks(heard)


def check_audit(cell):
    """Fails if the audit of the node has found a wrong tick."""
    if not AUDIT:
        print("no audit: the node has no parameter audit_rate")
        return
    cell.wait("an audit", lambda: "audit.checked" in cell.counters())
    counters = cell.counters()
    for line in cell.output.read_text(errors="replace").splitlines():
        if "the audit of tick" in line:
            print(line)
    expect("audit.different", 0, counters.get("audit.different", 0))
    print("audit: %d ticks checked, %d skipped" % (counters["audit.checked"], counters.get("audit.skipped", 0)))


def print_ticks(heard):
    """Prints how long the ticks in messages of ~status took."""
    times = sorted(timing.last for _, status in heard for timing in status.timings if timing.name == "tick")
    if times:
        print("ticks during the faults: %d, median %.2f ms, p99 %.2f ms" % (
            len(times), 1e3 * times[len(times) // 2], 1e3 * times[len(times) * 99 // 100]))


class Hang(BaseException):
    """A test takes too long. Not derived from Exception, because rospy catches each Exception."""


def on_alarm(*_):
    raise Hang("the test hangs: it should have ended at most %d s after the faults" % PATIENCE)


def main(test, simulated=False):
    """Runs test(cell, rng, seconds) with the arguments of the command line. Exits with 1 if it fails."""
    program = pathlib.Path(inspect.getfile(test)).resolve()
    parser = argparse.ArgumentParser(description=inspect.getmodule(test).__doc__)
    parser.add_argument("--seconds", type=float, default=20.0, help="how long the test causes faults")
    parser.add_argument("--seed", type=int, default=1, help="seed of all random choices")
    args = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))  # leaves the Cell, which then stops its processes
    signal.signal(signal.SIGALRM, on_alarm)
    signal.alarm(int(args.seconds) + PATIENCE)
    again = "test/chaos/run --seconds %g --seed %d %s" % (args.seconds, args.seed, program.stem)
    try:
        with Cell(simulated) as cell:
            test(cell, random.Random(args.seed), args.seconds)
    except (Failure, Hang) as failure:
        print("FAILED: %s\nrun it again: %s" % (failure, again))
        sys.exit(1)
    except Exception:
        traceback.print_exc(file=sys.stdout)
        print("FAILED: the test program has an error\nrun it again: " + again)
        sys.exit(1)
    print("passed: " + again)
