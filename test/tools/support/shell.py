# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""A shell in which a test types commands as a user would, in a folder of its own."""
import os
import re
import select
import subprocess
import time

# Commands that run until they are ended.
LASTING = re.compile(r"(\w+=\S+ )*(roscore|roslaunch|rosrun(?! hgrid_proximity make_srdf)|rostopic pub)\b")
END = "end of command"


class Shell:
    """One bash. What is exported or sourced in it counts for all later commands."""

    def __init__(self, environment, folder, patience):
        """@param patience  [s] longest time of a command"""
        self._patience = patience
        self._log = folder + "/shell.log"
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT}
        self._bash = subprocess.Popen(["bash"], env=environment, cwd=folder, start_new_session=True, **pipes)
        self._read = b""

    def type(self, command):
        """Types a command and waits for its end. Answers questions with y. Returns its exit code and its output.

        Does not wait for a command that runs until it is ended; its output is then its process id.
        """
        if LASTING.match(command):
            command = "%s </dev/null >>%s 2>&1 & echo $!" % (command, self._log)
        else:
            command = "{ %s\n} <<<$'y\\ny\\ny'" % command
        self._bash.stdin.write(("%s\nprintf '\\n%s %%d\\n' $?\n" % (command, END)).encode())
        self._bash.stdin.flush()
        lines = self._read_until_end(command)
        return int(lines[-1].split()[-1]), "\n".join(lines[:-1])

    def _read_until_end(self, command):
        deadline = time.monotonic() + self._patience
        while not re.search(rb"^%s \d+\n" % END.encode(), self._read, re.MULTILINE):
            ready, _, _ = select.select([self._bash.stdout], [], [], max(0.0, deadline - time.monotonic()))
            part = os.read(self._bash.stdout.fileno(), 1 << 16) if ready else b""
            if not part:
                raise AssertionError("'%s' did not end: %s" % (command, self._read.decode()))
            self._read += part
        lines, self._read = self._read.decode().rstrip("\n").split("\n"), b""
        return lines

    def end_jobs(self):
        """Ends all commands that still run. roslaunch ends its nodes when it gets SIGTERM."""
        self._end("$(jobs -pr)")

    def end_job(self, process):
        self._end(process)

    def _end(self, processes):
        """Ends processes in order; after half a minute, those that hang. A rospy node hangs if the signal comes just
        while it holds the lock of a publisher's queue, because its shutdown waits for this lock."""
        command = (
            "kill {0}; kill -CONT {0}; for i in {{1..300}}; do kill -0 {0} || break; sleep 0.1; done; "
            "kill -KILL {0}; wait {0}"
        )
        self.type("{ %s; } 2>/dev/null" % command.format(processes))

    def end(self):
        self.end_jobs()
        self._bash.communicate()
