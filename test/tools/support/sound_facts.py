# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Facts of a system without faults. Tests change them to create faults. Needs no ROS."""
import pathlib
import sys
from types import SimpleNamespace

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "tools"))

from hgrid_doctor.description import parse_srdf, parse_urdf  # noqa: E402  (the path comes first)
from hgrid_doctor.facts import (  # noqa: E402
    Environment, Facts, Graph, JointValue, NodeFacts, RobotFacts, TfStream, TopicFacts,
)
from hgrid_doctor.settings import RobotSettings, Settings  # noqa: E402

BOX = '<collision><geometry><box size="1 1 1"/></geometry></collision>'
MESH = '<collision><geometry><mesh filename="package://arm_meshes/hand.stl"/></geometry></collision>'
URDF = f"""<robot name="arm">
  <link name="base">{BOX}</link> <link name="elbow">{BOX}</link> <link name="hand">{MESH}</link> <link name="tip"/>
  <joint name="turn" type="revolute"><parent link="base"/><child link="elbow"/></joint>
  <joint name="bend" type="revolute"><parent link="elbow"/><child link="hand"/></joint>
  <joint name="weld" type="fixed"><parent link="hand"/><child link="tip"/></joint>
</robot>"""
SRDF = '<robot name="arm"><disable_collisions link1="base" link2="hand" reason="Never"/></robot>'
UNIT = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)  # the identity pose


def stamp(seconds):
    return SimpleNamespace(to_sec=lambda: seconds)


def stream(publisher, parent, child, offset=-0.005, pose=UNIT, static=False, count=50):
    poses = [(100.0 + 0.02 * number, pose) for number in range(count)]
    return TfStream(publisher, parent, child, static, count, [] if static else [offset] * count, 0, poses)


def source(name, complete=True, state=0, reason="", bodies=3, age=0.01):
    return SimpleNamespace(name=name, complete=complete, state=state, reason=reason, bodies=bodies, age=age)


def body(name, state, frame=""):
    return SimpleNamespace(name=name, state=state, frame=frame or name.rpartition("/")[2])


def counter(name, value):
    return SimpleNamespace(name=name, value=value)


def status(sequence=100, made=1000.0, **changes):
    world = SimpleNamespace(complete=True, incomplete_total=0, sequence=sequence, reasons=[])
    values = {
        "header": SimpleNamespace(frame_id="base"),
        "world": world,
        "made": stamp(made),
        "node_version": "0.1.0",
        "not_ready": [],
        "sources": [source("robot")],
        "sources_total": 1,
        "absent_robots": [],
        "bodies": [],
        "bodies_total": 0,
        "contested_frames": [],
        "clock_offsets": [],
        "uncovered": [],
        "model_warnings": [],
        "self_pairs": [SimpleNamespace(robot="robot", pairs=3, rigid=0, adjacent=1, srdf=1)],
        "counters": [],
        "timings": [SimpleNamespace(name="tick", median=0.001)],
        "pair_count": 1,
    }
    values.update(changes)
    return SimpleNamespace(**values)


def sound():
    """Returns the facts of one arm with its robot_state_publisher /rsp, its driver /driver, and the node /proximity."""
    graph = Graph(
        publishers={
            "/tf": ["/rsp"],
            "/tf_static": ["/rsp"],
            "/joint_states": ["/driver"],
            "/proximity/status": ["/proximity"],
        },
        subscribers={"/joint_states": ["/rsp"], "/tf": ["/proximity"], "/tf_static": ["/proximity"]},
        types={"/joint_states": "sensor_msgs/JointState", "/tf": "tf2_msgs/TFMessage"},
    )
    robot = RobotFacts(RobotSettings(), "/robot_description", [], parse_urdf(URDF))
    robot.semantic_key, robot.semantic = "/robot_description_semantic", parse_srdf(SRDF)
    names = ("/rsp", "/driver", "/proximity")
    return Facts(
        host="/proximity",
        environment=Environment("http://host:11311"),
        graph=graph,
        nodes={name: NodeFacts(name, f"http://host:{1000 + i}/", "host", pid=i) for i, name in enumerate(names)},
        pid_after=2,
        settings=Settings(),
        robots=[robot],
        listened=3.0,
        wall=1000.0,
        topics={"/proximity/status": TopicFacts({"/proximity": 150})},
        streams=[
            stream("/rsp", "base", "elbow"),
            stream("/rsp", "elbow", "hand"),
            stream("/rsp", "hand", "tip", static=True, count=1),
        ],
        joints={"/joint_states": {"turn": JointValue(0.0, 1), "bend": JointValue(0.0, 1)}},
        first_status=status(sequence=1),
        status=status(sequence=151),
    )
