# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""What can go wrong between a client and the node."""


class ProximityError(Exception):
    """Base class of the errors below. After a query, each of them means: treat the place as occupied."""


class NoAnswer(ProximityError):
    """The node does not run, does not answer in time, or the connection broke. The next call connects again."""


class Refused(ProximityError):
    """The node refused the request, or it failed.

    code: the reason as a word, such as "UNKNOWN_FRAME"; text: the reason as a sentence for people; failed_index:
    index of the refused change, from 0; also 0 if the whole request was refused; None for other requests.
    """

    def __init__(self, code: str, text: str, failed_index=None):
        super().__init__(f"{code}: {text}")
        self.code, self.text, self.failed_index = code, text, failed_index


class EventsMissed(ProximityError):
    """Events were lost on the way, for example because this program was too slow. Read ~pairs for the pairs that are near
    now."""
