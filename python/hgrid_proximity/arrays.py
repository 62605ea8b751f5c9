# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Reads ROS messages into numpy arrays.

Arrays of numbers become read-only numpy views of the received bytes. The numbers are not copied, so a message with
thousands of pairs is cheap to read. Such a message cannot be published.

    type of the field                    value
    numbers, such as float64[]           array of n numbers
    geometry_msgs/Point[] and other
      types with k float64 fields        array of n rows with k numbers: x, y, z
    time[], duration[]                   array of n int64 [ns], a copy
    everything else                      as rospy reads it
"""
from __future__ import annotations

import functools
import struct

import genpy
import numpy

_NUMBERS = {
    "bool": "?", "int8": "i1", "uint8": "u1", "byte": "i1", "char": "u1", "int16": "<i2", "uint16": "<u2",
    "int32": "<i4", "uint32": "<u4", "int64": "<i8", "uint64": "<u8", "float32": "<f4", "float64": "<f8",
}  # fmt: skip
_TIMES = {"time": (genpy.Time, "<u4"), "duration": (genpy.Duration, "<i4")}


def with_arrays(kind):
    """Returns a message class with the same fields as the class `kind`, whose arrays are numpy arrays.

    Use it to subscribe: `rospy.Subscriber(topic, with_arrays(Pairs), callback)`. Reading throws
    genpy.DeserializationError if the bytes end too early or contain more than the message.
    """

    def deserialize(self, data):
        source = _Bytes(data)
        try:
            _read_fields(source, self, kind)
            source.end()
        except (ValueError, struct.error) as error:
            raise genpy.DeserializationError(f"{kind._type}: {error}") from error
        return self

    members = {"__doc__": kind.__doc__, "__slots__": kind.__slots__, "deserialize": deserialize}  # genpy reads __slots__
    return type(kind.__name__, (kind,), members)


class _Bytes:
    """The bytes of a message, and how far they were read."""

    def __init__(self, data: bytes):
        self._data, self._at = data, 0

    def array(self, dtype: str, count: int) -> numpy.ndarray:
        begin, size = self._at, numpy.dtype(dtype).itemsize * count
        self._step(size)
        return numpy.frombuffer(self._data, dtype, count, begin)

    def text(self) -> str:
        length = self.number("<u4")
        begin = self._at
        self._step(length)
        return self._data[begin : self._at].decode("utf-8", "replace")

    def number(self, dtype: str):
        return self.array(dtype, 1)[0].item()

    def end(self):
        if self._at != len(self._data):
            raise ValueError(f"{len(self._data) - self._at} bytes are left over")

    def _step(self, size: int):
        if size > len(self._data) - self._at:
            raise ValueError(f"it ends after {len(self._data)} bytes, in the middle of a field")
        self._at += size


def _read_fields(source: _Bytes, message, kind):
    for name, read in _fields(kind):
        setattr(message, name, read(source))


@functools.lru_cache(maxsize=None)
def _fields(kind):
    """Returns the name of each field of a message class, and the function that reads it."""
    return [(name, _reader(of)) for name, of in zip(kind.__slots__, kind._slot_types)]


def _reader(of: str):
    """Returns a function that reads a value of this ROS type."""
    if of.endswith("]"):
        element, _, length = of[:-1].rpartition("[")
        return _array_reader(element, int(length) if length else None)
    if of in _NUMBERS:
        return lambda source: source.number(_NUMBERS[of])
    if of == "string":
        return _Bytes.text
    if of in _TIMES:
        kind, dtype = _TIMES[of]
        return lambda source: kind(*source.array(dtype, 2).tolist())
    return functools.partial(_read_message, genpy.message.get_message_class(of))


def _read_message(kind, source: _Bytes):
    message = kind()
    _read_fields(source, message, kind)
    return message


def _array_reader(element: str, length):
    """Returns a function that reads an array of this element type. @param length  None: the message gives the length"""

    def count(source):
        return source.number("<u4") if length is None else length

    if element in _NUMBERS:
        return lambda source: source.array(_NUMBERS[element], count(source))
    if element in _TIMES:
        return lambda source: _nanoseconds(source.array(_TIMES[element][1], 2 * count(source)))
    columns = _columns(element)
    if columns:
        return lambda source: source.array("<f8", columns * count(source)).reshape(-1, columns)
    read = _reader(element)
    return lambda source: [read(source) for _ in range(count(source))]


def _nanoseconds(pairs: numpy.ndarray) -> numpy.ndarray:
    return pairs[0::2].astype(numpy.int64) * 1_000_000_000 + pairs[1::2]


def _columns(element: str) -> int:
    """Returns the number of fields of a message type, if all of them are float64; otherwise 0."""
    kind = None if element == "string" else genpy.message.get_message_class(element)
    return len(kind._slot_types) if kind and set(kind._slot_types) == {"float64"} else 0
