#!/usr/bin/python3
"""Makes the UAV a robot of ROS 1: its sensors are topics, and topics command it.

An ordinary program on Tether's library. Start it beside your nodes, as the drivers on the UAV. Topics are relative,
so a namespace moves them. Parameters: ~clock (rate of /clock [Hz]; 0, the default: none), ~battery_period (1 s), ~tf
(true: odom -> base_link), ~frame_prefix ("").
"""

import threading
import time
from collections.abc import Callable
from typing import Any

import messages
import numpy as np
import rospy
import tether
from geometry_msgs.msg import PoseStamped, TransformStamped, Twist, TwistStamped
from messages import Sensor, Topic
from nav_msgs.msg import Odometry
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import BatteryState, JointState
from std_msgs.msg import Header
from tether.samples import CAMERAS, Kind, Quat, Vec3
from tf2_msgs.msg import TFMessage

SAMPLES_THAT_WAIT = {Kind.IMU: 50, Kind.ODOMETRY: 20}  # of other sensors, only the newest
NO_ROTATION, NOWHERE = Quat(1, 0, 0, 0), Vec3(0, 0, 0)


class Driver:
    """Has a thread for each sensor, which waits for it."""

    def __init__(self, vehicle: tether.Vehicle) -> None:
        self.vehicle = vehicle
        # What the clock of the system shows when ST begins.
        self.epoch_ns = max(time.time_ns() - vehicle.now_ns() for _ in range(5))
        self.prefix: str = rospy.get_param("~frame_prefix", "")
        self.has_tf: bool = rospy.get_param("~tf", True)
        self.tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        self.static = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        self.static.publish([edge for sensor in vehicle.sensors for edge in self.mounting(sensor)])

    def start(self) -> None:
        work: list[tuple[Sensor, list[tuple[Topic, Any]]]] = []
        taken: set[str] = set()
        for sensor in self.vehicle.sensors:
            if sensor.rate_hz == 0:
                rospy.logwarn("'%s' has no topic: it measures on demand. Give it a rate in the profile", sensor.name)
            else:
                work.append((sensor, [(topic, rospy.Publisher(topic.name, topic.type, queue_size=5, tcp_nodelay=True))
                                      for topic in messages.topics_of(sensor, taken)]))
        for sensor, topics in work:
            self.run(self.publish, sensor, topics)
        self.run(self.publish_battery, rospy.get_param("~battery_period", 1.0))
        if rate_hz := rospy.get_param("~clock", 0):
            self.run(self.publish_clock, 1 / rate_hz)
        for name, kind, act in (("cmd_vel", Twist, self.on_velocity), ("cmd_vel_stamped", TwistStamped, self.on_stamped),
                                ("command/pose", PoseStamped, self.on_pose)):
            rospy.Subscriber(name, kind, act, queue_size=1, tcp_nodelay=True)

    def run(self, work: Callable[..., None], *arguments: Any) -> None:
        def until_the_end() -> None:
            try:
                work(*arguments)
            except tether.RunEndedError:
                rospy.signal_shutdown("the run has ended")
            except (tether.TetherError, rospy.ROSException) as error:
                if not rospy.is_shutdown():
                    rospy.logerr("%s", error)

        threading.Thread(target=until_the_end, daemon=True).start()

    def header(self, sampled_at_ns: int, frame: str) -> Header:
        stamp = rospy.Time(*divmod(self.epoch_ns + sampled_at_ns, 10**9))
        return Header(stamp=stamp, frame_id=self.prefix + frame)

    # ---- Sensors ----

    def publish(self, sensor: Sensor, topics: list[tuple[Topic, Any]]) -> None:
        """Reads it while somebody wants it, as drivers of cameras do."""
        is_first = next(other for other in self.vehicle.sensors if other.kind == sensor.kind) is sensor
        moves = is_first and (sensor.kind == Kind.ODOMETRY and self.has_tf or sensor.kind == Kind.JOINT_STATE)
        is_read = False
        while not rospy.is_shutdown():
            is_moved = moves and self.tf.get_num_connections() > 0
            if not is_moved and not any(publisher.get_num_connections() for _, publisher in topics):
                is_read = False
                time.sleep(0.1)
                continue
            if not is_read and sensor.kind in SAMPLES_THAT_WAIT:
                sensor.set_queue(SAMPLES_THAT_WAIT[sensor.kind])  # without what came before
            is_read = True
            sample = sensor.read()
            if is_moved:
                self.tf.publish(self.edges(sensor, sample))
            for topic, publisher in topics:
                if publisher.get_num_connections():
                    message = topic.type(header=self.header(sample.sampled_at_ns, topic.frame))
                    topic.fill(sensor, message, sample)
                    self.complete(message)
                    publisher.publish(message)

    def complete(self, message: Any) -> None:
        if isinstance(message, Odometry):
            message.child_frame_id = self.prefix + message.child_frame_id
        elif isinstance(message, JointState):
            message.name = [joint.name for joint in self.vehicle.joints]

    def publish_battery(self, period_s: float) -> None:
        publisher = rospy.Publisher("battery_state", BatteryState, queue_size=1)
        while not rospy.is_shutdown():
            time.sleep(period_s)
            if publisher.get_num_connections():
                sample = self.vehicle.read_battery()
                message = BatteryState(header=self.header(sample.sampled_at_ns, "base_link"))
                messages.fill_battery(message, sample)
                publisher.publish(message)

    def publish_clock(self, period_s: float) -> None:
        publisher = rospy.Publisher("/clock", Clock, queue_size=1, tcp_nodelay=True)
        while not rospy.is_shutdown():
            now_s = time.time()
            publisher.publish(rospy.Time.from_sec(now_s))
            time.sleep(period_s - now_s % period_s)

    # ---- Frames ----

    def edge(self, header: Header, child: str, p: Vec3, q: Quat) -> TransformStamped:
        return TransformStamped(header, self.prefix + child, messages.transform(p, q))

    def mounting(self, sensor: Sensor) -> list[TransformStamped]:
        """From the body, or the last joint that turns it, to the sensor, and to a camera's optical frame."""
        parent, origin = "base_link", np.zeros(3)
        if sensor.joints:
            joint = self.vehicle.joints[sensor.joints - 1]
            parent, origin = joint.name, np.array(joint.point_B_m)
        p_BS, q_BS = sensor.mounting
        edges = [self.edge(self.header(0, parent), sensor.name, Vec3(*(p_BS - origin)), q_BS)]
        if sensor.kind in CAMERAS:
            edges.append(self.edge(self.header(0, sensor.name), sensor.name + "_optical", NOWHERE,
                                   messages.OPTICAL_IN_CAMERA))
        return edges

    def edges(self, sensor: Sensor, sample: Any) -> list[TransformStamped]:
        """What moves: the body in "odom", or each joint, whose axes are the body's when its angle is 0."""
        if sensor.kind == Kind.ODOMETRY:
            header = self.header(sample.sampled_at_ns, "odom")
            return [self.edge(header, "base_link", *messages.body_pose(sensor, sample))]
        edges, parent, origin = [], "base_link", np.zeros(3)
        for joint, angle_rad in zip(self.vehicle.joints, sample.angles_rad):
            point = np.array(joint.point_B_m)
            edges.append(self.edge(self.header(sample.sampled_at_ns, parent), joint.name, Vec3(*(point - origin)),
                                   messages.rotation(joint.axis_B, angle_rad)))
            parent, origin = joint.name, point
        return edges

    # ---- Commands ----

    def command(self, setpoint: tether.Setpoint) -> None:
        try:
            self.vehicle.command(setpoint)
        except tether.RunEndedError:
            rospy.signal_shutdown("the run has ended")

    def on_velocity(self, twist: Any, in_heading: bool = True) -> None:
        v = twist.linear
        self.command(tether.Setpoint(velocity_m_s=(v.x, v.y, v.z), yaw_rate_rad_s=twist.angular.z,
                                     in_heading=in_heading))

    def knows(self, frame: str, *known: str) -> bool:
        if frame in known or frame in [self.prefix + name for name in known]:
            return True
        rospy.logwarn_once("commands in the frame '%s' are refused; known are %s", frame, known)
        return False

    def on_stamped(self, message: Any) -> None:
        if self.knows(message.header.frame_id, "", "base_link", "odom"):
            self.on_velocity(message.twist, in_heading=message.header.frame_id != self.prefix + "odom")

    def on_pose(self, message: Any) -> None:
        if not self.knows(message.header.frame_id, "", "odom"):
            return
        p, q = message.pose.position, message.pose.orientation
        yaw_rad = np.arctan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y**2 + q.z**2))
        self.command(tether.Setpoint(position_W_m=(p.x, p.y, p.z), yaw_rad=float(yaw_rad)))


def main() -> None:
    vehicle = tether.connect()  # not closed at the end: threads wait in it, which end with the process
    rospy.init_node("driver")
    Driver(vehicle).start()
    rospy.spin()


if __name__ == "__main__":
    main()
