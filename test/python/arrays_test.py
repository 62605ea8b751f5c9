#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Reads and writes random messages as arrays, and compares them with what genpy reads. Needs no master."""
import io
import random
import unittest

import genpy
import numpy
import rospy
from hgrid_proximity import msg, srv
from hgrid_proximity.arrays import with_arrays
from hgrid_proximity.streams import DistanceArrays, EventArrays, PairArrays

KINDS = [kind for kind in vars(msg).values() if isinstance(kind, type) and issubclass(kind, genpy.Message)]
REQUESTS = [kind for name, kind in vars(srv).items() if name.endswith("Request")]
RANGES = {"int8": 7, "uint8": 8, "int16": 15, "uint16": 16, "int32": 31, "uint32": 32, "int64": 63, "uint64": 64}


def random_value(rng, of):
    """Returns a random value of this ROS type."""
    if of.endswith("]"):
        element, _, length = of[:-1].rpartition("[")
        values = [random_value(rng, element) for _ in range(int(length) if length else rng.randrange(4))]
        return bytes(values) if element in ("uint8", "char") else values
    if of == "bool":
        return rng.random() < 0.5
    if of in RANGES:
        return rng.randrange(2 ** RANGES[of])
    if of in ("float32", "float64"):
        return rng.choice([0.0, -0.5, 1.25, float("inf"), rng.randrange(1000) / 8.0])
    if of == "string":
        return "".join(rng.choice("abc/_é\n") for _ in range(rng.randrange(6)))
    if of == "time":
        return genpy.Time(rng.randrange(2**32), rng.randrange(10**9))
    if of == "duration":
        return genpy.Duration(rng.randrange(-(2**31), 2**31), rng.randrange(10**9))
    return random_message(rng, genpy.message.get_message_class(of))


def random_message(rng, kind):
    message = kind()
    for name, of in zip(kind.__slots__, kind._slot_types):
        setattr(message, name, random_value(rng, of))
    return message


def written(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def filled(message, source):
    """Gives a message the fields of another."""
    for name in source.__slots__:
        setattr(message, name, getattr(source, name))
    return message


def has_times(of):
    """Returns whether a message type, or a type in it, has an array of times."""
    return any(field in ("time[]", "duration[]") or "/" in field and has_times(
        genpy.message.get_message_class(field.rpartition("[")[0] or field)) for field in of._slot_types)


def plain(value):
    """Returns a value without numpy, with messages as lists of their fields and times as nanoseconds."""
    if isinstance(value, numpy.ndarray):
        return value.tolist()
    if isinstance(value, genpy.Message):
        return [plain(getattr(value, name)) for name in type(value).__slots__]
    if isinstance(value, genpy.TVal):
        return value.to_nsec()
    if isinstance(value, (list, tuple, bytes)):
        return [plain(element) for element in value]
    return value


class Arrays(unittest.TestCase):
    def test_have_the_values_that_genpy_reads(self):
        rng = random.Random(1)
        self.assertGreater(len(KINDS), 30)
        for kind in KINDS:
            for _ in range(20):
                data = written(random_message(rng, kind))
                expected, actual = kind().deserialize(data), with_arrays(kind)().deserialize(data)
                self.assertEqual(plain(actual), plain(expected), kind._type)

    def test_are_views_of_the_message_that_cannot_be_written(self):
        message = msg.Pairs(names=["a", "b"], first=[0], second=[1], gap=[0.5])
        data = written(message)
        arrays = PairArrays().deserialize(data)
        whole = numpy.frombuffer(data, numpy.uint8)
        for array in (arrays.first, arrays.gap):
            self.assertTrue(numpy.shares_memory(array, whole))
            with self.assertRaises(ValueError):
                array[0] = 1

    # Claim: a message that was read as arrays is written as the same bytes, if it has no arrays of times.
    def test_are_written_as_the_same_bytes(self):
        rng = random.Random(4)
        kinds = [kind for kind in KINDS + REQUESTS if not has_times(kind)]
        self.assertGreater(len(kinds), 30)
        for kind in kinds:
            for _ in range(20):
                data = written(random_message(rng, kind))
                self.assertEqual(written(with_arrays(kind)().deserialize(data)), data, kind._type)
                self.assertEqual(written(filled(with_arrays(kind)(), kind().deserialize(data))), data, kind._type)

    def test_that_do_not_fit_are_not_written(self):
        kind = with_arrays(srv.QueryBatchRequest)
        for field, value in (("sphere_center", numpy.zeros((2, 4))), ("sphere_center", numpy.zeros(3)),
                             ("sphere_radius", numpy.zeros((2, 1))), ("sphere_radius", ["a"]), ("limit", -1),
                             ("sphere_radius", numpy.zeros(2, complex)),
                             ("box_size", numpy.zeros(3)), ("include", [1]), ("as_body", 1)):
            with self.assertRaisesRegex(genpy.SerializationError, "QueryBatchRequest: " + field):
                written(kind(**{field: value}))

    def test_with_numbers_out_of_range_are_not_written(self):
        kind = with_arrays(msg.Pairs)
        for numbers in ([2**32], [-1]):
            with self.assertRaisesRegex(genpy.SerializationError, "Pairs: first: .* uint32"):
                written(kind(first=numpy.array(numbers)))
        self.assertEqual(kind().deserialize(written(kind(first=numpy.array([2**32 - 1])))).first.tolist(), [2**32 - 1])
        self.assertEqual(kind().deserialize(written(kind(gap=numpy.array([1, 2])))).gap.tolist(), [1.0, 2.0])

    def test_have_a_row_for_each_point(self):
        message = random_message(random.Random(2), msg.Distances)
        arrays = DistanceArrays().deserialize(written(message))
        self.assertEqual(arrays.point_on_first.shape, (len(message.point_on_first), 3))
        self.assertEqual(arrays.measured.dtype, numpy.int64)

    def test_are_of_the_same_type_on_the_wire(self):
        for arrays, kind in ((PairArrays, msg.Pairs), (DistanceArrays, msg.Distances), (EventArrays, msg.Events)):
            self.assertEqual((arrays._type, arrays._md5sum), (kind._type, kind._md5sum))

    def test_can_be_printed(self):
        self.assertIn("gap", str(PairArrays().deserialize(written(msg.Pairs(gap=[0.5])))))

    def test_refuse_every_message_that_is_cut_or_too_long(self):
        rng = random.Random(3)
        for kind in (PairArrays, DistanceArrays, EventArrays):
            data = written(random_message(rng, kind))
            for length in range(len(data)):
                with self.assertRaises(genpy.DeserializationError):
                    kind().deserialize(data[:length])
            with self.assertRaisesRegex(genpy.DeserializationError, "1 bytes are left over"):
                kind().deserialize(data + b"\0")

    def test_refuse_lengths_that_do_not_fit(self):
        data = bytearray(written(msg.Pairs(gap=[0.5])))
        place = data.rindex(b"\1\0\0\0")
        for length in (2, 2**31, 2**32 - 1):
            data[place : place + 4] = length.to_bytes(4, "little")
            with self.assertRaises(genpy.DeserializationError):
                PairArrays().deserialize(bytes(data))


class Select(unittest.TestCase):
    def pairs(self):
        names = ["map/hall", "obstacle/a.b", "obstacle/axb", "robot/[1]", "robot/arm/hand"]
        each = [(i, j) for i in range(len(names)) for j in range(i + 1, len(names))]
        first, second = [list(column) for column in zip(*each)]
        return PairArrays().deserialize(written(msg.Pairs(names=names, first=first, second=second)))

    def selected(self, *globs):
        pairs = self.pairs()
        return [(pairs.first_names[i], pairs.second_names[i]) for i in pairs.select(*globs)]

    def test_finds_pairs_in_either_order(self):
        expected = [("map/hall", "obstacle/a.b"), ("map/hall", "obstacle/axb")]
        self.assertEqual(self.selected("map/*", "obstacle/*"), expected)
        self.assertEqual(self.selected("obstacle/*", "map/*"), expected)

    def test_needs_one_body_for_each_glob(self):
        self.assertEqual(self.selected("robot/*", "robot/*"), [("robot/[1]", "robot/arm/hand")])
        self.assertEqual(self.selected("map/hall", "map/*"), [])

    def test_reads_no_other_characters_as_patterns(self):
        self.assertEqual(len(self.selected("obstacle/a.b")), 4)
        self.assertEqual(len(self.selected("robot/[1]")), 4)
        self.assertEqual(self.selected("robot/1"), [])
        self.assertEqual(len(self.selected("obstacle/a?b", "map/*")), 2)

    def test_of_everything_is_everything(self):
        self.assertEqual(len(self.selected()), 10)


class Usable(unittest.TestCase):
    def test_needs_a_complete_message_that_is_still_valid(self):
        rospy.rostime.set_rostime_initialized(True)
        now = rospy.Time.now()
        for complete, left, expected in ((True, 10, True), (True, -1, False), (False, 10, False)):
            pairs = msg.Pairs()
            pairs.world.complete = complete
            pairs.world.valid_until = now + rospy.Duration(left)
            self.assertEqual(PairArrays().deserialize(written(pairs)).usable, expected)


if __name__ == "__main__":
    import rosunit

    rosunit.unitrun("hgrid_proximity", "arrays", "__main__")
