# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Messages and services of the proximity node (`msg`, `srv`), and a client for Python (`client`)."""

import threading

if not hasattr(threading.Thread, "isAlive"):
    # rospy 1.15.9 (Debian 11) calls it when a program ends, although Python 3.9 has no such function any more.
    threading.Thread.isAlive = threading.Thread.is_alive
