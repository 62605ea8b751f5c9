# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Checks whether the files that descriptions and parameters name can be read on this computer."""
from __future__ import annotations

import os
from functools import lru_cache
from typing import List, Optional
from urllib.parse import unquote

import rospkg

from hgrid_doctor.facts import MeshError, MeshFlaw


@lru_cache(maxsize=None)
def package_folder(package: str) -> str:
    """Returns the folder of a package; empty if the package is not found."""
    try:
        return rospkg.RosPack().get_path(package)
    except rospkg.ResourceNotFound:
        return ""


def mesh_error(uri: str, roots: List[str]) -> Optional[MeshError]:
    """Returns why a mesh cannot be read; None if it can be read.

    @param roots  folders in which the files of file:// URIs may be
    """
    if uri.startswith("package://"):
        package, _, path = uri[len("package://") :].partition("/")
        folder = package_folder(package)
        if not folder:
            return MeshError(MeshFlaw.NO_PACKAGE, f"there is no package '{package}'")
        return unreadable(file_error(os.path.join(folder, path)))
    if uri.startswith("file:///"):
        path = unquote(uri[len("file://") :])
        real = os.path.realpath(path)
        allowed = [*roots, *os.environ.get("ROS_PACKAGE_PATH", "").split(":")]
        if not any(root and real.startswith(os.path.realpath(root).rstrip("/") + "/") for root in allowed):
            return MeshError(MeshFlaw.OUTSIDE, "it lies outside the packages and ~mesh_roots")
        return unreadable(file_error(path))
    return unreadable("only package:// and file:/// are read")


def unreadable(text: str) -> Optional[MeshError]:
    return MeshError(MeshFlaw.UNREADABLE, text) if text else None


def file_error(path: str) -> str:
    if not os.path.exists(path):
        return f"there is no file {path}"
    if not os.path.isfile(path):
        return f"{path} is no regular file"
    return "" if os.access(path, os.R_OK) else f"{path} may not be read by this user"
