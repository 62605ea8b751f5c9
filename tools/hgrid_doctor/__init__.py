# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""What `doctor` is made of.

`observe` reads a running system and makes plain data of it (`facts`), `checks` are pure functions from that data to
findings, `report` prints them.
"""
