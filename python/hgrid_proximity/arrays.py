# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Reads ROS messages into numpy arrays, and writes them from numpy arrays.

Arrays of numbers become read-only numpy views of the received bytes. The numbers are not copied, so a message with
thousands of pairs is cheap to read.

    type of the field                    value
    numbers, such as float64[]           array of n numbers
    geometry_msgs/Point[] and other
      types that only have k float64     array of n rows with k numbers: x, y, z
    time[], duration[]                   array of n int64 [ns], a copy
    everything else                      as rospy reads it

Fields can be assigned the same kinds of values before a message is written. Lists, such as rospy uses, are always
accepted. For time[] and duration[], only lists of genpy.Time and genpy.Duration are accepted.
"""
from __future__ import annotations

import functools
import struct

import genpy
import numpy

_NUMBERS = {
    "bool": "<?", "int8": "<b", "uint8": "<B", "byte": "<b", "char": "<B", "int16": "<h", "uint16": "<H", "int32": "<i",
    "uint32": "<I", "int64": "<q", "uint64": "<Q", "float32": "<f", "float64": "<d",
}  # struct and numpy understand these; fmt: skip
_TIMES = {"time": (genpy.Time, "<I"), "duration": (genpy.Duration, "<i")}


def with_arrays(kind):
    """Returns a message class with the same fields as the class `kind`. Its arrays are numpy arrays.

    Use it to subscribe: `rospy.Subscriber(topic, with_arrays(Pairs), callback)`. Reading throws
    genpy.DeserializationError if the message ends too early or is followed by further bytes. Writing throws
    genpy.SerializationError if a value has a wrong type or shape, or if a number is out of the range of its field.
    """

    def serialize(self, buff):
        try:
            _write_message(kind, buff, self)
        except (AttributeError, TypeError, ValueError, struct.error) as error:
            raise genpy.SerializationError(f"{kind._type}: {error}") from error

    def deserialize(self, data):
        source = _Bytes(data)
        try:
            _read_fields(source, self, kind)
            source.end()
        except (ValueError, struct.error) as error:
            raise genpy.DeserializationError(f"{kind._type}: {error}") from error
        return self

    members = {"__doc__": kind.__doc__, "__slots__": kind.__slots__}  # genpy reads __slots__
    members.update(serialize=serialize, deserialize=deserialize)
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
        length = self.number("<I")
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
        return source.number("<I") if length is None else length

    if element in _NUMBERS:
        return lambda source: source.array(_NUMBERS[element], count(source))
    if element in _TIMES:
        return lambda source: _nanoseconds(source.array(_TIMES[element][1], 2 * count(source)))
    columns = _columns(element)
    if columns:
        return lambda source: source.array("<d", columns * count(source)).reshape(-1, columns)
    read = _reader(element)
    return lambda source: [read(source) for _ in range(count(source))]


def _nanoseconds(pairs: numpy.ndarray) -> numpy.ndarray:
    return pairs[0::2].astype(numpy.int64) * 1_000_000_000 + pairs[1::2]


@functools.lru_cache(maxsize=None)
def _columns(of: str) -> int:
    """Returns how many numbers a message type has if all its fields, or the fields of these, are float64; otherwise 0."""
    if of == "float64":
        return 1
    if of in _NUMBERS or of in _TIMES or of == "string" or of.endswith("]"):
        return 0
    columns = [_columns(field) for field in genpy.message.get_message_class(of)._slot_types]
    return sum(columns) if all(columns) else 0


@functools.lru_cache(maxsize=None)
def _writer(of: str):
    """Returns a function that writes a value of this ROS type into a buffer."""
    if of.endswith("]"):
        element, _, length = of[:-1].rpartition("[")
        return _array_writer(element, int(length) if length else None)
    if of in _NUMBERS:
        return lambda buff, value: buff.write(struct.pack(_NUMBERS[of], value))
    if of == "string":
        return _write_text
    if of in _TIMES:
        return lambda buff, value: buff.write(struct.pack(_TIMES[of][1].replace("<", "<2"), value.secs, value.nsecs))
    return functools.partial(_write_message, genpy.message.get_message_class(of))


def _write_message(kind, buff, message):
    for name, of in zip(kind.__slots__, kind._slot_types):
        try:
            _writer(of)(buff, getattr(message, name))
        except (AttributeError, TypeError, ValueError, struct.error) as error:
            raise ValueError(f"{name}: {error}") from error


def _write_text(buff, value):
    data = value if isinstance(value, bytes) else value.encode("utf-8")
    buff.write(struct.pack("<I", len(data)) + data)


def _array_writer(element: str, length):
    """Returns a function that writes an array or a list. @param length  None: the length is written as well"""
    dtype = _NUMBERS.get(element)
    columns = 0 if dtype or element in _TIMES else _columns(element)
    write = _writer(element)

    def write_list(buff, value):
        if length not in (None, len(value)):
            raise ValueError(f"it has {len(value)} elements; it must have {length}")
        if length is None:
            buff.write(struct.pack("<I", len(value)))
        if isinstance(value, numpy.ndarray) and (dtype or columns):
            if value.shape[1:] != ((columns,) if columns else ()):
                raise ValueError(f"its shape is {value.shape}; it must be {('n', columns) if columns else ('n',)}")
            buff.write(_converted(value, dtype or "<d", element).tobytes())
        elif dtype:
            buff.write(struct.pack(f"<{len(value)}{dtype[1]}", *value))
        else:
            for one in value:
                write(buff, one)

    return write_list


def _converted(value: numpy.ndarray, dtype: str, element: str) -> numpy.ndarray:
    """Returns the numbers of an array in another type. @throws ValueError if a number cannot be represented"""
    to = numpy.dtype(dtype)
    if value.dtype.kind not in {"b": "b", "i": "biu", "u": "biu", "f": "biuf"}[to.kind]:
        raise ValueError(f"it is an array of {value.dtype}; it must be of {element}")
    with numpy.errstate(over="ignore"):
        data = numpy.ascontiguousarray(value, to)
    fits = numpy.isinf(data) == numpy.isinf(value) if to.kind == "f" else data == value
    if not numpy.all(fits):
        raise ValueError(f"a number is out of the range of {element}")
    return data
