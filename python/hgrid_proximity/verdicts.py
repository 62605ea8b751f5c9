# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""What the answers to many questions in one request have in common."""
from __future__ import annotations

import numpy

from hgrid_proximity.errors import Refused
from hgrid_proximity.msg import Verdict


class Verdicts:
    """Exactly one of `clear`, `hit` and `unknown` is True for each question.

    clear, hit, unknown: arrays of n bools
    response: the whole response of the service; response.lease names the state of the world
    """

    def __init__(self, response):
        if not response.success:
            raise Refused(response.code.name, response.code.text)
        self.response = response
        verdicts = numpy.frombuffer(response.verdicts, numpy.uint8)  # genpy reads uint8[] as bytes
        self.clear, self.hit = verdicts == Verdict.CLEAR, verdicts == Verdict.HIT
        self.unknown = ~(self.clear | self.hit)

    def __len__(self):
        return len(self.clear)

    def __bool__(self):
        raise TypeError("an answer is neither true nor false; read .clear, .hit or .unknown")

    def text(self, index: int) -> str:
        """Returns why a question is UNKNOWN or was refused; empty for all other questions."""
        return self.response.texts[index] if self.response.texts else ""
