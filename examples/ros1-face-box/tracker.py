#!/usr/bin/python3
"""Turns the UAV until a blue box is in the middle of the image.

It reads /camera/image_raw and writes /cmd_vel. It turns at a constant rate, and halves the rate each
time the box has passed the middle. Exit code 0: the box was in the middle for half a second.
"""

import math
import sys

import cv2
import cv_bridge
import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import Image

FIELD_OF_VIEW_DEG = 80.0
PRECISION_DEG = 2.0
HELD_S = 0.5
LIMIT_S = 8.0
RATE_DEG_S, LEAST_RATE_DEG_S = 25.0, 2.0


def bearing_deg(image):
    """Of the blue box, positive to the left; none: it is not seen."""
    hsv = cv2.cvtColor(cv2.medianBlur(image, 9), cv2.COLOR_BGR2HSV)
    found = cv2.moments(cv2.inRange(hsv, (105, 150, 30), (130, 255, 255)), True)
    if found["m00"] < 30:
        return None
    half = image.shape[1] / 2
    focal = half / math.tan(math.radians(FIELD_OF_VIEW_DEG / 2))
    return math.degrees(math.atan((half - 0.5 - found["m10"] / found["m00"]) / focal))


class Tracker:
    def __init__(self):
        self.rate, self.side = RATE_DEG_S, 0
        self.begun = self.inside_since = None
        self.result = None
        self.bridge = cv_bridge.CvBridge()
        self.commands = rospy.Publisher("/cmd_vel", Twist, queue_size=1)
        rospy.Subscriber("/camera/image_raw", Image, self.track, queue_size=1, buff_size=2**24)

    def turn(self, rate_deg_s):
        command = Twist()
        command.angular.z = math.radians(rate_deg_s)
        self.commands.publish(command)

    def track(self, message):
        # The bridge is ready for commands when it listens.
        if self.result is not None or self.commands.get_num_connections() == 0:
            return
        now = rospy.get_time()
        self.begun = self.begun or now
        bearing = bearing_deg(self.bridge.imgmsg_to_cv2(message, "bgr8"))
        if now - self.begun > LIMIT_S:
            self.result = False
        elif bearing is None:
            self.turn(self.rate)
        elif abs(bearing) < PRECISION_DEG:
            self.turn(0.0)
            self.inside_since = self.inside_since or now
            if now - self.inside_since > HELD_S:
                self.result = True
        else:
            self.inside_since = None
            if self.side * bearing < 0:
                self.rate = max(LEAST_RATE_DEG_S, self.rate / 2)
            self.side = math.copysign(1, bearing)
            self.turn(self.side * self.rate)
        latency_ms = (rospy.Time.now() - message.header.stamp).to_sec() * 1e3
        print(f"{now:.3f} {bearing} deg, {self.rate:.1f} deg/s, {latency_ms:.2f} ms", flush=True)


def main():
    rospy.init_node("tracker")
    tracker = Tracker()
    rate = rospy.Rate(20)
    while tracker.result is None and not rospy.is_shutdown():
        rate.sleep()
    tracker.turn(0.0)
    print("the box is in the middle" if tracker.result else "it did not stay in the middle")
    return 0 if tracker.result else 1


if __name__ == "__main__":
    sys.exit(main())
