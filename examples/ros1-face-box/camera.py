#!/usr/bin/python3
"""Publishes the images of the first camera on /camera/image_raw."""

import cv2
import cv_bridge
import rospy
from sensor_msgs.msg import Image


def main():
    rospy.init_node("camera")
    publisher = rospy.Publisher("/camera/image_raw", Image, queue_size=1)
    bridge = cv_bridge.CvBridge()
    camera = cv2.VideoCapture(0, cv2.CAP_V4L2)
    while not rospy.is_shutdown():
        ok, image = camera.read()
        if not ok:
            return
        message = bridge.cv2_to_imgmsg(image, "bgr8")
        message.header.stamp = rospy.Time.now()
        publisher.publish(message)


if __name__ == "__main__":
    main()
