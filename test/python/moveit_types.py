# SPDX-License-Identifier: BSD-3-Clause
# SPDX-FileCopyrightText: the hgrid_proximity authors
"""Message and service classes of moveit_msgs and control_msgs, made from lists of their fields, because these packages are
not available on all machines. The MD5 of each class says that the fields are the right ones."""
import genmsg
import genmsg.gentools
import genmsg.msg_loader
import genpy.dynamic
import rospkg

FIELDS = {
    "octomap_msgs/Octomap": "Header header\nbool binary\nstring id\nfloat64 resolution\nint8[] data",
    "octomap_msgs/OctomapWithPose": "Header header\ngeometry_msgs/Pose origin\noctomap_msgs/Octomap octomap",
    "object_recognition_msgs/ObjectType": "string key\nstring db",
    "moveit_msgs/CollisionObject": """Header header
        geometry_msgs/Pose pose
        string id
        object_recognition_msgs/ObjectType type
        shape_msgs/SolidPrimitive[] primitives
        geometry_msgs/Pose[] primitive_poses
        shape_msgs/Mesh[] meshes
        geometry_msgs/Pose[] mesh_poses
        shape_msgs/Plane[] planes
        geometry_msgs/Pose[] plane_poses
        string[] subframe_names
        geometry_msgs/Pose[] subframe_poses
        byte ADD=0
        byte REMOVE=1
        byte APPEND=2
        byte MOVE=3
        byte operation""",
    "moveit_msgs/AttachedCollisionObject": """string link_name
        CollisionObject object
        string[] touch_links
        trajectory_msgs/JointTrajectory detach_posture
        float64 weight""",
    "moveit_msgs/RobotState": """sensor_msgs/JointState joint_state
        sensor_msgs/MultiDOFJointState multi_dof_joint_state
        AttachedCollisionObject[] attached_collision_objects
        bool is_diff""",
    "moveit_msgs/RobotTrajectory": """trajectory_msgs/JointTrajectory joint_trajectory
        trajectory_msgs/MultiDOFJointTrajectory multi_dof_joint_trajectory""",
    "moveit_msgs/DisplayTrajectory": "string model_id\nRobotTrajectory[] trajectory\nRobotState trajectory_start",
    "control_msgs/JointTolerance": "string name\nfloat64 position\nfloat64 velocity\nfloat64 acceleration",
    "control_msgs/FollowJointTrajectoryGoal": """trajectory_msgs/JointTrajectory trajectory
        JointTolerance[] path_tolerance
        JointTolerance[] goal_tolerance
        duration goal_time_tolerance""",
    "control_msgs/FollowJointTrajectoryActionGoal": """Header header
        actionlib_msgs/GoalID goal_id
        FollowJointTrajectoryGoal goal""",
    "control_msgs/FollowJointTrajectoryResult": """int32 error_code
        string error_string
        int32 SUCCESSFUL=0
        int32 INVALID_GOAL=-1
        int32 INVALID_JOINTS=-2
        int32 OLD_HEADER_TIMESTAMP=-3
        int32 PATH_TOLERANCE_VIOLATED=-4
        int32 GOAL_TOLERANCE_VIOLATED=-5""",
    "control_msgs/FollowJointTrajectoryActionResult": """Header header
        actionlib_msgs/GoalStatus status
        FollowJointTrajectoryResult result""",
    "actionlib_msgs/GoalStatusArray": "Header header\nGoalStatus[] status_list",
    "moveit_msgs/AllowedCollisionEntry": "bool[] enabled",
    "moveit_msgs/AllowedCollisionMatrix": """string[] entry_names
        AllowedCollisionEntry[] entry_values
        string[] default_entry_names
        bool[] default_entry_values""",
    "moveit_msgs/LinkPadding": "string link_name\nfloat64 padding",
    "moveit_msgs/LinkScale": "string link_name\nfloat64 scale",
    "moveit_msgs/ObjectColor": "string id\nstd_msgs/ColorRGBA color",
    "moveit_msgs/PlanningSceneWorld": "CollisionObject[] collision_objects\noctomap_msgs/OctomapWithPose octomap",
    "moveit_msgs/PlanningScene": """string name
        RobotState robot_state
        string robot_model_name
        geometry_msgs/TransformStamped[] fixed_frame_transforms
        AllowedCollisionMatrix allowed_collision_matrix
        LinkPadding[] link_padding
        LinkScale[] link_scale
        ObjectColor[] object_colors
        PlanningSceneWorld world
        bool is_diff""",
    "moveit_msgs/PlanningSceneComponents": """uint32 SCENE_SETTINGS=1
        uint32 ROBOT_STATE=2
        uint32 ROBOT_STATE_ATTACHED_OBJECTS=4
        uint32 WORLD_OBJECT_NAMES=8
        uint32 WORLD_OBJECT_GEOMETRY=16
        uint32 OCTOMAP=32
        uint32 TRANSFORMS=64
        uint32 ALLOWED_COLLISION_MATRIX=128
        uint32 LINK_PADDING_AND_SCALING=256
        uint32 OBJECT_COLORS=512
        uint32 components""",
    "moveit_msgs/JointConstraint": """string joint_name
        float64 position
        float64 tolerance_above
        float64 tolerance_below
        float64 weight""",
    "moveit_msgs/BoundingVolume": """shape_msgs/SolidPrimitive[] primitives
        geometry_msgs/Pose[] primitive_poses
        shape_msgs/Mesh[] meshes
        geometry_msgs/Pose[] mesh_poses""",
    "moveit_msgs/PositionConstraint": """Header header
        string link_name
        geometry_msgs/Vector3 target_point_offset
        BoundingVolume constraint_region
        float64 weight""",
    "moveit_msgs/OrientationConstraint": """Header header
        geometry_msgs/Quaternion orientation
        string link_name
        float64 absolute_x_axis_tolerance
        float64 absolute_y_axis_tolerance
        float64 absolute_z_axis_tolerance
        uint8 parameterization
        uint8 XYZ_EULER_ANGLES=0
        uint8 ROTATION_VECTOR=1
        float64 weight""",
    "moveit_msgs/VisibilityConstraint": """float64 target_radius
        geometry_msgs/PoseStamped target_pose
        int32 cone_sides
        geometry_msgs/PoseStamped sensor_pose
        float64 max_view_angle
        float64 max_range_angle
        uint8 SENSOR_Z=0
        uint8 SENSOR_Y=1
        uint8 SENSOR_X=2
        uint8 sensor_view_direction
        float64 weight""",
    "moveit_msgs/Constraints": """string name
        JointConstraint[] joint_constraints
        PositionConstraint[] position_constraints
        OrientationConstraint[] orientation_constraints
        VisibilityConstraint[] visibility_constraints""",
    "moveit_msgs/ContactInformation": """Header header
        geometry_msgs/Point position
        geometry_msgs/Vector3 normal
        float64 depth
        string contact_body_1
        uint32 body_type_1
        string contact_body_2
        uint32 body_type_2
        uint32 ROBOT_LINK=0
        uint32 WORLD_OBJECT=1
        uint32 ROBOT_ATTACHED=2""",
    "moveit_msgs/CostSource": """float64 cost_density
        geometry_msgs/Vector3 aabb_min
        geometry_msgs/Vector3 aabb_max""",
    "moveit_msgs/ConstraintEvalResult": "bool result\nfloat64 distance",
}
SERVICES = {
    "moveit_msgs/GetStateValidity": """RobotState robot_state
        string group_name
        Constraints constraints
        ---
        bool valid
        ContactInformation[] contacts
        CostSource[] cost_sources
        ConstraintEvalResult[] constraint_result""",
    "moveit_msgs/GetPlanningScene": "PlanningSceneComponents components\n---\nPlanningScene scene",
    "moveit_msgs/ApplyPlanningScene": "PlanningScene scene\n---\nbool success",
}

class Types:
    """The classes of Noetic. Those of moveit_msgs have their name without package: types["CollisionObject"],
    types["control_msgs/JointTolerance"], types.service("GetPlanningScene")."""

    def __init__(self):
        self._context = genmsg.MsgContext.create_default()
        self._search = {}
        for package in ("std_msgs", "geometry_msgs", "shape_msgs", "sensor_msgs", "trajectory_msgs", "actionlib_msgs"):
            self._search[package] = [rospkg.RosPack().get_path(package) + "/msg"]
        for name, fields in FIELDS.items():
            lines = [line.strip() for line in fields.split("\n")]
            self._specs(name, "\n".join(lines))
        self._classes = {}

    def __getitem__(self, name):
        full = name if "/" in name else "moveit_msgs/" + name
        if full not in self._classes:
            self._make(self._context.get_registered(full))
        return self._classes[full]

    def service(self, name):
        """Returns a class for rospy.ServiceProxy and rospy.Service."""
        full = "moveit_msgs/" + name
        fields = "\n".join(line.strip() for line in SERVICES[full].split("\n"))
        spec = genmsg.msg_loader.load_srv_from_string(self._context, fields, full)
        for part in (spec.request, spec.response):
            genmsg.msg_loader.load_depends(self._context, part, self._search)
            self._make(part)
        return type(
            name,
            (),
            {
                "_type": full,
                "_md5sum": genmsg.gentools.compute_md5(self._context, spec),
                "_request_class": self._classes[full + "Request"],
                "_response_class": self._classes[full + "Response"],
            },
        )

    def _specs(self, name, text):
        genmsg.msg_loader.load_msg_from_string(self._context, text, name)

    def _make(self, spec):
        """Makes the class of a type, and those of all types that it contains."""
        genmsg.msg_loader.load_depends(self._context, spec, self._search)
        text = genmsg.gentools.compute_full_text(self._context, spec)
        self._classes.update(genpy.dynamic.generate_dynamic(spec.full_name, text))
