#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Writes corner.stl, a binary STL file of the tetrahedron that all files corner.* in this folder contain."""
import pathlib
import struct

A, B, C, D = (0, 0, 0), (0.5, 0, 0), (0, 0.25, 0), (0, 0, 0.125)
FACES = [(A, C, B), (A, B, D), (A, D, C), (B, C, D)]

data = b"a tetrahedron, metres".ljust(80, b" ") + struct.pack("<I", len(FACES))
for face in FACES:
    data += struct.pack("<3f", 0, 0, 0) + b"".join(struct.pack("<3f", *v) for v in face) + struct.pack("<H", 0)
pathlib.Path(__file__).with_name("corner.stl").write_bytes(data)
