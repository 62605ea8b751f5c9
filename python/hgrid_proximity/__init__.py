# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Messages and services of the proximity node (`msg`, `srv`), and a client for Python (`client`)."""
