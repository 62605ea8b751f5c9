# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Calls that end in time, whatever they call: a name server, a stopped process, a disk that is gone."""
from __future__ import annotations

import threading
import time
from dataclasses import dataclass
from typing import Any, Callable, Dict, Hashable


@dataclass
class Outcome:
    """What a call returned, or why it did not."""

    value: Any = None
    error: str = ""  # empty: it returned


def call_all(calls: Dict[Hashable, Callable[[], Any]], timeout: float) -> Dict[Hashable, Outcome]:
    """Runs calls side by side and gives all of them `timeout` [s] together. What has not ended then goes on in a
    daemon thread, and its result is not read."""
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
    except Exception as error:  # whatever it is, it is the answer
        outcomes[key] = Outcome(error=sentence_of(error))


def sentence_of(error: Exception) -> str:
    """What people need of it: no error numbers."""
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return text or type(error).__name__
