# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The request and the answer of Proximity.query_batch(), as numpy arrays."""
from __future__ import annotations

from typing import List

import numpy

from hgrid_proximity.arrays import with_arrays
from hgrid_proximity.srv import QueryBatch, QueryBatchRequest, QueryBatchResponse
from hgrid_proximity.values import UPRIGHT
from hgrid_proximity.verdicts import Verdicts


class QueryBatchArrays(QueryBatch):
    """The service ~query_batch with arrays in its request and its response, as `hgrid_proximity.arrays` describes."""

    _request_class = with_arrays(QueryBatchRequest)
    _response_class = with_arrays(QueryBatchResponse)


class Batch(Verdicts):
    """The answer to query_batch(). It has `clear`, `hit`, `unknown` and `text()` of Verdicts.

    total: array of n numbers: how many bodies each question hit, listed or not; for points and bodies: listed hits only
    nearest: [m] array of n numbers: distance of the first hit of each question (for a segment: the first along it), 0 if
        they overlap; NaN: no hit
    response: the arrays of all hits, such as response.distance (`rossrv show -r hgrid_proximity/QueryBatch`)
    """

    def __init__(self, response):
        super().__init__(response)
        self.total = response.totals
        self._end = response.hits_end.astype(int)
        self._begin = numpy.concatenate(([0], self._end))[:-1]
        self.nearest = numpy.full(len(self), numpy.nan)
        listed = self._end > self._begin
        self.nearest[listed] = response.distance[self._begin[listed]]

    def hits(self, index: int) -> slice:
        """Returns the slice that selects the hits of a question in the arrays of `response`."""
        return slice(self._begin[index], self._end[index])

    def names(self, index: int) -> List[str]:
        """Returns the names of the bodies that a question hit."""
        return [self.response.names[body] for body in self.response.body[self.hits(index)]]


def write_geometry(request, spheres, segments, boxes, points):
    """Writes the arguments of query_batch() into the request. @throws ValueError if an array has a wrong shape"""
    centers, radii = _parts("spheres", spheres, 2)
    request.sphere_center = _rows("centers of spheres", centers, 3)
    request.sphere_radius = _column("radii of spheres", radii, len(request.sphere_center))
    starts, ends, radii = _parts("segments", segments, 3)
    request.segment_start = _rows("starts of segments", starts, 3)
    request.segment_end = _rows("ends of segments", ends, 3, len(request.segment_start))
    request.segment_radius = _column("radii of segments", radii, len(request.segment_start))
    centers, sizes, orientations = _parts("boxes", boxes, 3)
    centers = _rows("centers of boxes", centers, 3)
    orientations = numpy.tile(UPRIGHT, (len(centers), 1)) if orientations is None else orientations
    orientations = _rows("orientations of boxes", orientations, 4, len(centers))
    request.box_pose = numpy.hstack((centers, orientations))
    request.box_size = _rows("sizes of boxes", sizes, 3, len(centers))
    request.nearest_to_point = _rows("points", () if points is None else points, 3)


def _parts(name: str, value, count: int):
    """Returns the arrays of a kind of question. Without questions these are empty."""
    if value is None:
        return ((),) * count
    parts = tuple(value)
    if name == "boxes" and len(parts) == 2:
        parts += (None,)
    if len(parts) != count:
        wanted = {"spheres": "(centers, radii)", "segments": "(starts, ends, radii)",
                  "boxes": "(centers, sizes) or (centers, sizes, orientations)"}[name]
        raise ValueError(f"{name} has {len(parts)} elements; it must be {wanted}")
    return parts


def _rows(name: str, values, columns: int, count=None) -> numpy.ndarray:
    rows = numpy.asarray(values, "<f8")
    rows = rows.reshape(0, columns) if rows.size == 0 else rows
    if rows.ndim != 2 or rows.shape[1] != columns or count not in (None, len(rows)):
        of = "n" if count is None else count
        raise ValueError(f"the {name} have the shape {rows.shape}; it must be ({of}, {columns})")
    return rows


def _column(name: str, values, count: int) -> numpy.ndarray:
    """Returns an array with one number for each question. @param values  such an array, or one number for all questions"""
    numbers = numpy.asarray(values, "<f8")
    numbers = numpy.full(count, numbers) if numbers.ndim == 0 else numbers
    if numbers.shape != (count,):
        raise ValueError(f"the {name} have the shape {numbers.shape}; it must be ({count},), or one number for all")
    return numbers
