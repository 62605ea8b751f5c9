# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Calls the XML-RPC interfaces of the master and of nodes. Every call has a timeout."""
from __future__ import annotations

import http.client
import os
import socket
import xmlrpc.client
from typing import Any, Dict, List
from urllib.parse import urlparse

from hgrid_doctor.facts import Environment, Graph, NodeFacts
from hgrid_doctor.observe.bounded import call, call_all

CALLER = f"/hgrid_doctor_{os.getpid()}"  # name of this program in calls; it is not registered with the master
DEFAULT_MASTER = "http://localhost:11311"


class ApiError(Exception):
    """The master or node refused the call. The text is the one that it sent."""


class _Transport(xmlrpc.client.Transport):
    def __init__(self, timeout):
        super().__init__()
        self._timeout = timeout

    def make_connection(self, host):
        return http.client.HTTPConnection(host, timeout=self._timeout)


class Api:
    """The XML-RPC interface of the master or of a node at a URI."""

    def __init__(self, uri: str, timeout: float):
        self._uri = uri
        self._timeout = timeout

    def __call__(self, method: str, *arguments: Any, caller: str = CALLER) -> Any:
        """Calls a method. @throws ApiError, OSError"""
        try:
            proxy = xmlrpc.client.ServerProxy(self._uri, _Transport(self._timeout), allow_none=True)
            code, text, value = getattr(proxy, method)(caller, *arguments)
        except (http.client.HTTPException, xmlrpc.client.Error, ValueError, TypeError) as error:
            raise ApiError(f"{self._uri} answers, but not as ROS does: {error}") from error
        if code != 1:
            raise ApiError(text)
        return value


def read_environment(timeout: float) -> Environment:
    environment = Environment(
        master_uri=os.environ.get("ROS_MASTER_URI", "").strip() or DEFAULT_MASTER,
        master_uri_is_set=bool(os.environ.get("ROS_MASTER_URI", "").strip()),
        ros_ip=os.environ.get("ROS_IP", "").strip(),
        ros_hostname=os.environ.get("ROS_HOSTNAME", "").strip(),
    )
    own_name = environment.ros_hostname or environment.ros_ip or socket.gethostname()
    environment.own_name = own_name
    environment.own_name_error = call(lambda: _check_own(own_name), timeout).error
    environment.address_towards_master = call(lambda: _address_towards(environment.master_uri), timeout).value or ""
    return environment


def _check_own(name):
    """Checks a host name. @throws OSError if it cannot be resolved, or is not an address of this computer"""
    try:
        addresses = socket.getaddrinfo(name, 0, type=socket.SOCK_STREAM)
    except socket.gaierror as error:
        raise OSError(f"it cannot be resolved ({error.strerror})") from error
    for family, kind, protocol, _, address in addresses:
        try:
            with socket.socket(family, kind, protocol) as probe:
                probe.bind(address)
            return
        except OSError:
            continue
    raise OSError(f"it is no address of this computer ({addresses[0][4][0]})")


def _address_towards(uri):
    """Returns the address of this computer from which packets to the host of the URI are sent. Sends nothing."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.connect((urlparse(uri).hostname, 1))
        return probe.getsockname()[0]


def read_graph(uri: str, timeout: float) -> Graph:
    """Returns what the master knows. If the master does not answer, `error` says why."""
    graph = Graph()
    if urlparse(uri).scheme != "http" or not urlparse(uri).hostname:
        graph.error = "it is not of the form http://host:port"
        return graph
    master = Api(uri, timeout)
    answers = call_all(
        {
            "state": lambda: master("getSystemState"),
            "types": lambda: dict(map(tuple, master("getTopicTypes"))),
            "sim": lambda: bool(optional(master, "getParam", "/use_sim_time")),
        },
        timeout,
    )
    graph.error = answers["state"].error or answers["types"].error or answers["sim"].error
    if graph.error:
        return graph
    publishers, subscribers, services = answers["state"].value
    graph.publishers = {topic: list(nodes) for topic, nodes in publishers}
    graph.subscribers = {topic: list(nodes) for topic, nodes in subscribers}
    graph.services = {service: list(nodes) for service, nodes in services}
    graph.types = answers["types"].value
    graph.use_sim_time = answers["sim"].value
    return graph


def optional(master: Api, method: str, *arguments: Any, caller: str = CALLER) -> Any:
    """Calls a method of the master. Returns None if the master says that the requested thing does not exist."""
    try:
        return master(method, *arguments, caller=caller)
    except ApiError:
        return None


def ask_nodes(uri: str, names: List[str], timeout: float) -> Dict[str, NodeFacts]:
    """Looks up all nodes and asks them for their process ids, in parallel."""
    master = Api(uri, timeout)
    places = call_all({name: lambda name=name: master("lookupNode", name) for name in names}, timeout)
    nodes = {name: NodeFacts(name, uri=place.value or "", error=place.error) for name, place in places.items()}
    registered = {name: node for name, node in nodes.items() if node.uri}
    hosts = {urlparse(node.uri).hostname or "" for node in registered.values()}
    found = call_all({host: lambda host=host: socket.getaddrinfo(host, 0) for host in hosts}, timeout)
    calls = {name: lambda uri=node.uri: Api(uri, timeout)("getPid") for name, node in registered.items()}
    pings = call_all(calls, timeout)
    for name, node in registered.items():
        node.host = urlparse(node.uri).hostname or ""
        node.host_error = found[node.host].error
        node.pid, node.error = pings[name].value, pings[name].error
    return nodes
