#!/usr/bin/python3
"""A companion computer's program: turns the UAV until a blue box is in the middle of the image.

It reads the first camera by OpenCV, and talks MAVLink 2 to the flight controller over UDP, as PX4
offers it to companions (port 14540). It turns at a constant rate, and halves the rate each time the
box has passed the middle. Exit code 0: the box was in the middle for half a second.

usage: mavlink_face_anchor.py [FIELD_OF_VIEW_DEG]
"""

import math
import socket
import struct
import sys
import time

try:
    import cv2
except ImportError:
    sys.exit("mavlink_face_anchor.py needs Debian's package python3-opencv")

HEARTBEAT, COMMAND, ACK, SET_POINT, TEXT = 0, 76, 77, 84, 253
EXTRA = {HEARTBEAT: 50, COMMAND: 152, ACK: 143, SET_POINT: 143, TEXT: 83}  # of the checksums
SET_MODE, OFFBOARD = 176, 6
VELOCITY_AND_YAW_RATE = 0b0000_0101_1100_0111

PRECISION_DEG = 2.0
HELD_S = 0.5
LIMIT_S = 8.0
RATE_DEG_S, LEAST_RATE_DEG_S = 25.0, 2.0


def checksum(data):
    crc = 0xFFFF
    for byte in data:
        byte ^= crc & 0xFF
        byte ^= (byte << 4) & 0xFF
        crc = (crc >> 8) ^ (byte << 8) ^ (byte << 3) ^ (byte >> 4)
        crc &= 0xFFFF
    return crc


class FlightController:
    def __init__(self, port=14540):
        self.link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.link.bind(("0.0.0.0", port))
        self.sequence = 0
        _, self.address = self.link.recvfrom(4096)

    def send(self, message, layout, *values):
        payload = struct.pack(layout, *values)
        header = struct.pack("<BBBBBBHB", len(payload), 0, 0, self.sequence, 1, 191, message, 0)
        crc = checksum(header + payload + bytes([EXTRA[message]]))
        self.link.sendto(b"\xfd" + header + payload + struct.pack("<H", crc), self.address)
        self.sequence = (self.sequence + 1) % 256

    def receive(self, wanted, seconds):
        """The payload of the next message of that kind, if one comes in time."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            self.link.settimeout(left)
            try:
                frame, self.address = self.link.recvfrom(4096)
            except TimeoutError:
                return None
            length = frame[1]
            body, crc = frame[1:10 + length], frame[10 + length:12 + length]
            if frame[0] != 0xFD or int.from_bytes(frame[7:10], "little") != wanted:
                continue
            if checksum(body + bytes([EXTRA[wanted]])) == int.from_bytes(crc, "little"):
                return frame[10:10 + length]
        return None

    def turn(self, rate_deg_s):
        """To the left, and stays where it is."""
        self.send(SET_POINT, "<IfffffffffffHBBB", 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                  -math.radians(rate_deg_s), VELOCITY_AND_YAW_RATE, 1, 1, 1)

    def go_offboard(self):
        for _ in range(15):  # it wants a stream of set-points first
            self.turn(0.0)
            time.sleep(0.1)
        self.send(COMMAND, "<fffffffHBBB", 1, OFFBOARD, 0, 0, 0, 0, 0, SET_MODE, 1, 1, 0)
        ack = self.receive(ACK, 1.0)
        return ack is not None and struct.unpack("<HB", ack[:2] + b"\0")[0] == SET_MODE


def bearing_deg(image, field_of_view_deg):
    """Of the blue box, positive to the left; none: it is not seen."""
    hsv = cv2.cvtColor(cv2.medianBlur(image, 9), cv2.COLOR_BGR2HSV)
    found = cv2.moments(cv2.inRange(hsv, (105, 150, 30), (130, 255, 255)), True)
    if found["m00"] < 30:
        return None
    half = image.shape[1] / 2
    focal = half / math.tan(math.radians(field_of_view_deg / 2))
    return math.degrees(math.atan((half - 0.5 - found["m10"] / found["m00"]) / focal))


def face(controller, camera, field_of_view_deg):
    rate, side, inside_since = RATE_DEG_S, 0, None
    begun = time.monotonic()
    while (now := time.monotonic()) - begun < LIMIT_S:
        ok, image = camera.read()
        if not ok:
            return False
        bearing = bearing_deg(image, field_of_view_deg)
        if bearing is None:
            controller.turn(rate)
            continue
        if abs(bearing) < PRECISION_DEG:
            controller.turn(0.0)
            inside_since = inside_since or now
            if now - inside_since > HELD_S:
                return True
            continue
        inside_since = None
        if side * bearing < 0:
            rate = max(LEAST_RATE_DEG_S, rate / 2)
        side = math.copysign(1, bearing)
        controller.turn(side * rate)
        print(f"{now:.3f} {bearing:6.1f} deg, {side * rate:.1f} deg/s")
    return False


def main():
    field_of_view_deg = float(sys.argv[1]) if len(sys.argv) > 1 else 80.0
    cv2.setNumThreads(1)
    camera = cv2.VideoCapture(0, cv2.CAP_V4L2)
    if not camera.isOpened():
        sys.exit("there is no camera")
    controller = FlightController()
    if not controller.go_offboard():
        sys.exit("the flight controller does not take set-points")
    faced = face(controller, camera, field_of_view_deg)
    controller.turn(0.0)
    print("the box is in the middle" if faced else "it did not stay in the middle")
    return 0 if faced else 1


if __name__ == "__main__":
    sys.exit(main())
