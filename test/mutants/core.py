# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Builds and tests mutants of the core, in a copy of the sources under build/mutants."""

import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
COPY = ROOT / "build" / "mutants"
FEW_VALUES = re.findall("^HGRID_TEST.*", (ROOT / "test/support/few_values").read_text(), re.MULTILINE)
PROGRAMS = COPY / "programs"  # one folder with test programs for each mutant that is being tested
TESTS = ["geometry_test", "broadphase_test", "maps_test", "bodies_test", "pairs_test", "world_test", "history_test",
         "queries_test", "distances_test", "explain_test", "planes_test", "narrow_test", "states_test"]


def prepare():
    """Copies the files that the core's tests need, and configures the build of the copy."""
    for name in ["cmake", "core", "include", "src", "msg", "test", "package.xml"]:
        path = ROOT / name
        for source in path.rglob("*") if path.is_dir() else [path]:
            target = COPY / source.relative_to(ROOT)
            if source.is_dir() or "mutants" in source.parts[len(ROOT.parts):]:
                continue
            # Unchanged files keep their times, and a second run builds little.
            if not target.exists() or target.read_bytes() != source.read_bytes():
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, target)
    subprocess.run(["cmake", "-S", str(COPY / "test"), "-B", str(COPY / "build"), "-DCMAKE_BUILD_TYPE=None",
                    "-DCMAKE_CXX_FLAGS=-O1", "-DHGRID_ADAPTERS=OFF", "-DHGRID_UNITY=8"], check=True, stdout=subprocess.DEVNULL)


def unmutated():
    """Builds the tests without a mutant. Returns the same kind of values as build()."""
    compile_tests()
    return commands("unmutated", TESTS)


def build(name, file, text):
    """Builds the tests while a file in src/ has the content `text`.

    @returns the commands that run the tests, and a folder to delete after them
    """
    path = COPY / "src" / file
    original = path.read_text()
    path.write_text(text)
    try:
        compile_tests()
    finally:
        path.write_text(original)
    # The tests of the folder that contains the mutant run first.
    first = "states_test" if "/states/" in file else file.split("/")[0] + "_test"
    return commands(name, sorted(TESTS, key=lambda test: (test != first, TESTS.index(test))))


def commands(name, tests):
    """Copies the test programs, because the next mutant is built while they run. Returns the same as build()."""
    folder = PROGRAMS / name
    folder.mkdir(parents=True, exist_ok=True)
    for test in tests:
        shutil.copy(COPY / "build" / test, folder)
    return [["env"] + FEW_VALUES + [str(folder / test)] for test in tests], folder


def compile_tests():
    done = subprocess.run(["cmake", "--build", str(COPY / "build"), "-j2", "--target"] + TESTS,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    if done.returncode != 0:
        sys.exit(done.stdout + "\nThe build failed. If it contains a mutant, correct its replacement in table.py.")
