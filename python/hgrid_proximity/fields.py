# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The answer of Proximity.distance_field(), as numpy arrays."""
from __future__ import annotations

import numpy

from hgrid_proximity.arrays import with_arrays
from hgrid_proximity.errors import Refused
from hgrid_proximity.srv import DistanceField, DistanceFieldRequest, DistanceFieldResponse


class FieldArrays(DistanceField):
    """The service ~distance_field with arrays in its response, as `hgrid_proximity.arrays` describes."""

    _request_class = DistanceFieldRequest
    _response_class = with_arrays(DistanceFieldResponse)


class Field:
    """A distance field: point (i, j, k) is at `resolution` * (i, j, k) in the frame of the lattice.

    distance: [m] array of the shape (nx, ny, nz): signed distance, negative inside a body; NaN: not known, see `text`
    gradient: array of the shape (nx, ny, nz, 3): gradient in the frame of the lattice; None unless it was requested. 0
        where the distance is max_distance or -max_distance; NaN where the distance or the gradient is not known
    unknown: number of points whose distance is NaN
    text: why the distance of the first of these points is not known; empty if no point is NaN
    response: the whole response of the service; response.lease names the state of the world
    """

    def __init__(self, response):
        if not response.success:
            raise Refused(response.code.name, response.code.text)
        self.response, self.unknown, self.text = response, response.unknown, response.text
        shape = tuple(response.count[::-1])  # the last index of a numpy array changes fastest
        self.distance = response.distance.reshape(shape).transpose(2, 1, 0)
        self.gradient = None
        if len(response.gradient):
            self.gradient = response.gradient.reshape(shape + (3,)).transpose(2, 1, 0, 3)
