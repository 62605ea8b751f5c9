# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""The modules of `doctor`.

`observe` reads a running system and stores what it sees as plain data (`facts`). `checks` are pure functions that turn
facts into findings. `report` prints the findings.
"""
