# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Tells catkin where the Python modules are. Not to be called by hand; catkin_python_setup() reads it."""
from catkin_pkg.python_setup import generate_distutils_setup
from setuptools import setup

setup(**generate_distutils_setup(packages=["hgrid_proximity"], package_dir={"": "python"}))
