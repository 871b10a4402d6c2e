#!/usr/bin/python3
"""Flies to the wall ahead, and keeps 1 m away and square to it: reads /scan, and writes /cmd_vel.

The wall is the line that most points of the scan ahead are on. Exit code 0: distance and angle were right for 2 s, and
it never came nearer than 0.75 m.
"""

import math
import sys

import numpy as np
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan

DISTANCE_M, PRECISION_M, PRECISION_RAD = 1.0, 0.1, math.radians(3)
LEAST_M = 0.75
HELD_S, LIMIT_S = 2.0, 10.0
GAIN_PER_S, FASTEST_M_S = 2.2, 1.5
TURN_GAIN_PER_S, FASTEST_RAD_S = 1.6, 0.8
AHEAD_RAD = math.radians(60)
LINES, INLIER_M = 2000, 0.03


def find_wall(scan, random):
    """Distance and angle of the wall's normal, positive to the left; none: there is no wall."""
    angles = scan.angle_min + scan.angle_increment * np.arange(len(scan.ranges))
    ranges = np.array(scan.ranges)
    seen = np.isfinite(ranges) & (np.abs(angles) < AHEAD_RAD)
    points = np.column_stack((ranges * np.cos(angles), ranges * np.sin(angles)))[seen]
    if len(points) < 20:
        return None
    first, second = points[random.integers(len(points), size=(2, LINES))]
    along = second - first
    lengths = np.hypot(*along.T)
    normals = np.column_stack((along[:, 1], -along[:, 0])) / np.maximum(lengths, 1e-9)[:, None]
    errors = np.abs(normals @ points.T - np.sum(normals * first, axis=1)[:, None])
    inside = points[(errors < INLIER_M)[np.argmax((errors < INLIER_M).sum(axis=1) * (lengths > 0.2))]]
    middle = inside.mean(axis=0)
    normal = np.linalg.svd(inside - middle, full_matrices=False)[2][1]
    normal *= np.sign(normal @ middle)
    return normal @ middle, math.atan2(normal[1], normal[0])


class Keeper:
    def __init__(self):
        self.random = np.random.default_rng(1)
        self.begun = self.right_since = self.result = None
        self.commands = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        rospy.Subscriber("scan", LaserScan, self.keep, queue_size=1)

    def fly(self, ahead_m_s, turn_rad_s):
        command = Twist()
        command.linear.x = min(max(ahead_m_s, -FASTEST_M_S), FASTEST_M_S)
        command.angular.z = min(max(turn_rad_s, -FASTEST_RAD_S), FASTEST_RAD_S)
        self.commands.publish(command)

    def keep(self, scan):
        # The UAV is ready for commands when it listens.
        if self.result is not None or self.commands.get_num_connections() == 0:
            return
        now = rospy.get_time()
        self.begun = self.begun or now
        wall = find_wall(scan, self.random)
        if now - self.begun > LIMIT_S or (wall is not None and wall[0] < LEAST_M):
            self.result = False
        elif wall is None:
            self.fly(0.0, 0.0)
        else:
            error, angle = wall[0] - DISTANCE_M, wall[1]
            self.fly(GAIN_PER_S * error, TURN_GAIN_PER_S * angle)
            if abs(error) > PRECISION_M or abs(angle) > PRECISION_RAD:
                self.right_since = None
            elif now - (self.right_since or now) > HELD_S:
                self.result = True
            else:
                self.right_since = self.right_since or now
            latency_ms = (rospy.Time.now() - scan.header.stamp).to_sec() * 1e3
            print(f"{now:.3f} {wall[0]:.3f} m, {math.degrees(angle):.1f} deg, {latency_ms:.2f} ms", flush=True)


def main():
    rospy.init_node("wall_keeper")
    keeper = Keeper()
    rate = rospy.Rate(20)
    while keeper.result is None and not rospy.is_shutdown():
        rate.sleep()
    keeper.fly(0.0, 0.0)
    print("1 m from the wall" if keeper.result else "too near to the wall, or not for long enough at 1 m")
    return 0 if keeper.result else 1


if __name__ == "__main__":
    sys.exit(main())
