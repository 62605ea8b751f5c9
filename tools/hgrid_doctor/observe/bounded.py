# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Calls with a time limit. The limit also holds if a name server, a process or a disk does not answer."""
from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from typing import Any, Callable, Dict, Hashable


@dataclass
class Outcome:
    """The value that a call returned, or the reason why it did not return one."""

    value: Any = None
    error: str = ""  # empty if the call returned a value


def call_all(calls: Dict[Hashable, Callable[[], Any]], timeout: float) -> Dict[Hashable, Outcome]:
    """Runs calls in parallel. All of them together have `timeout` [s]. A call that has not ended by then continues
    in a daemon thread, and its result is not used."""
    outcomes = {key: Outcome(error=f"no answer within {timeout:g} s") for key in calls}
    threads = []
    for key, function in calls.items():
        thread = threading.Thread(target=_run, args=(function, outcomes, key), daemon=True)
        thread.start()
        threads.append(thread)
    deadline = time.monotonic() + timeout
    for thread in threads:
        thread.join(max(0.0, deadline - time.monotonic()))
    return dict(outcomes)


def call(function: Callable[[], Any], timeout: float) -> Outcome:
    return call_all({"": function}, timeout)[""]


def _run(function, outcomes, key):
    try:
        outcomes[key] = Outcome(value=function())
    except Exception as error:  # any exception is the outcome of the call
        outcomes[key] = Outcome(error=sentence_of(error))


def sentence_of(error: Exception) -> str:
    """Returns the text of an error for people, without error numbers."""
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return text or type(error).__name__
