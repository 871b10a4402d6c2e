#!/usr/bin/python3
"""Sends /cmd_vel to the flight controller, by MAVLink 2 over UDP as PX4 offers it (port 14540)."""

import socket
import struct
import threading

import rospy
from geometry_msgs.msg import Twist

COMMAND, SET_POINT = 76, 84
EXTRA = {COMMAND: 152, SET_POINT: 143}  # of the checksums
SET_MODE, OFFBOARD = 176, 6
VELOCITY_AND_YAW_RATE = 0b0000_0101_1100_0111
FORWARD_LEFT_UP_IS_FRD = 8  # the frame of the set-point: that of the body


def checksum(data):
    crc = 0xFFFF
    for byte in data:
        byte ^= crc & 0xFF
        byte ^= (byte << 4) & 0xFF
        crc = (crc >> 8) ^ (byte << 8) ^ (byte << 3) ^ (byte >> 4)
        crc &= 0xFFFF
    return crc


class Bridge:
    def __init__(self):
        self.link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.link.bind(("0.0.0.0", 14540))
        _, self.address = self.link.recvfrom(4096)
        self.sequence = 0
        self.command = Twist()
        threading.Thread(target=self.receive, daemon=True).start()

    def send(self, message, layout, *values):
        payload = struct.pack(layout, *values)
        header = struct.pack("<BBBBBBHB", len(payload), 0, 0, self.sequence, 1, 191, message, 0)
        crc = checksum(header + payload + bytes([EXTRA[message]]))
        self.link.sendto(b"\xfd" + header + payload + struct.pack("<H", crc), self.address)
        self.sequence = (self.sequence + 1) % 256

    def receive(self):
        while True:
            self.link.recvfrom(4096)

    def set_velocity(self, command):
        self.command = command
        linear, angular = command.linear, command.angular
        self.send(SET_POINT, "<IfffffffffffHBBB", 0, 0, 0, 0, linear.x, -linear.y, -linear.z, 0, 0,
                  0, 0, -angular.z, VELOCITY_AND_YAW_RATE, 1, 1, FORWARD_LEFT_UP_IS_FRD)

    def go_offboard(self):
        rate = rospy.Rate(10)
        for _ in range(15):  # it wants a stream of set-points first
            self.set_velocity(self.command)
            rate.sleep()
        self.send(COMMAND, "<fffffffHBBB", 1, OFFBOARD, 0, 0, 0, 0, 0, SET_MODE, 1, 1, 0)


def main():
    rospy.init_node("mavlink_bridge")
    bridge = Bridge()
    bridge.go_offboard()
    rospy.Subscriber("/cmd_vel", Twist, bridge.set_velocity, queue_size=1)
    rospy.spin()


if __name__ == "__main__":
    main()
