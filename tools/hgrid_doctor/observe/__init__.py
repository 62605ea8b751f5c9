# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Reads a running ROS system. Nothing is registered with the master, and nothing is changed."""
