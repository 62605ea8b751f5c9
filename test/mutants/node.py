# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Builds and tests mutants of the node.

Compiles only the changed file, into a library of its own. A test loads this library before the library of the node
(LD_PRELOAD). Then the functions of the changed file replace those of the node. The tests are those that scripts/test
has built; they are not built again.
"""

import pathlib
import re
import shlex
import subprocess
import sys

from core import FEW_VALUES

ROOT = pathlib.Path(__file__).resolve().parents[2]
COPY = ROOT / "build" / "mutants" / "node"
FLAGS = ROOT / "build" / "release" / "CMakeFiles" / "hgrid_proximity_node.dir" / "flags.make"
PROGRAMS = ROOT / "devel" / "lib" / "hgrid_proximity"
TESTS = ["parts_unit_test", "wire_test", "freshness_unit_test"]  # none of them needs a ROS master


def prepare():
    """Checks that the node and its tests have been built."""
    for needed in [FLAGS] + [PROGRAMS / test for test in TESTS]:
        if not needed.exists():
            sys.exit("%s does not exist; the mutants of the node need what scripts/test builds: run it first" % needed)


def unmutated():
    """Returns the same kind of values as build(), for the tests without a mutant."""
    return commands([]), COPY


def build(name, file, text):
    """Compiles the content `text` in place of a file of src/.

    @returns the commands that run the tests, and a folder to delete after them
    """
    folder = COPY / name
    folder.mkdir(parents=True, exist_ok=True)
    source, library = folder / pathlib.Path(file).name, folder / "mutant.so"
    source.write_text(text)
    done = subprocess.run(["c++"] + flags() + ["-O1", "-w", "-shared", str(source), "-o", str(library)],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    if done.returncode != 0:
        sys.exit(done.stdout + "\nThe mutant does not compile. Correct its replacement in table.py.")
    return commands(["LD_PRELOAD=%s" % library]), folder


def commands(variables):
    return [["env"] + FEW_VALUES + variables + [str(PROGRAMS / test)] for test in TESTS]


def flags():
    """Returns the compiler flags of the library of the node."""
    lines = re.findall(r"^CXX_(?:DEFINES|INCLUDES|FLAGS) = (.*)$", FLAGS.read_text(), re.MULTILINE)
    return [flag for line in lines for flag in shlex.split(line) if flag != "-Werror"]
