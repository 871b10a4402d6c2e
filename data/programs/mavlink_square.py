#!/usr/bin/env python3
"""A companion computer's program: takes off, flies a square by velocity set-points, and lands.

It talks MAVLink 2 to the flight controller (PX4 or ArduPilot) over UDP port 14540, and needs nothing
but Python. Ten times a second it plans: it simulates the next second for many
velocities, and commands the one that ends nearest to the corner. Exit code 0: it was at each corner
for half a second, and has landed.

usage: mavlink_square.py [SIDE_M [HEIGHT_M]]
"""

import math
import socket
import struct
import sys
import time

# id: (extra checksum, struct of the payload, names of its fields)
MESSAGES = {
    0: (50, "<IBBBBB", "custom_mode type autopilot base_mode system_status version"),
    32: (185, "<Iffffff", "time_boot_ms x y z vx vy vz"),
    76: (152, "<fffffffHBBB", "p1 p2 p3 p4 p5 p6 p7 command system component confirmation"),
    77: (143, "<HB", "command result"),
    84: (143, "<IfffffffffffHBBB",
         "time_boot_ms x y z vx vy vz afx afy afz yaw yaw_rate type_mask system component frame"),
    245: (130, "<BB", "vtol_state landed_state"),
    253: (83, "<B50s", "severity text"),
}
HEARTBEAT, POSITION, COMMAND, ACK, SET_POINT, STATE, TEXT = MESSAGES

ARM, TAKE_OFF, LAND, SET_MODE, SET_INTERVAL = 400, 22, 21, 176, 511
ARDUPILOT = 3
VELOCITY_ONLY = 0b0000_1101_1100_0111 & ~0b1000_0000_0000 | 0b0100_0000_0000
PERIOD_S = 0.1


def checksum(data):
    crc = 0xFFFF
    for byte in data:
        byte ^= crc & 0xFF
        byte ^= (byte << 4) & 0xFF
        crc = (crc >> 8) ^ (byte << 8) ^ (byte << 3) ^ (byte >> 4)
        crc &= 0xFFFF
    return crc


class FlightController:
    """The MAVLink link: what it told last, and what can be asked of it."""

    def __init__(self, port=14540):
        self.link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.link.bind(("0.0.0.0", port))
        self.address = None
        self.system = 1
        self.sequence = 0
        self.last = {}
        self.heartbeat_at = 0.0

    def send(self, message, *values):
        extra, layout, _ = MESSAGES[message]
        payload = struct.pack(layout, *values).rstrip(b"\0") or b"\0"
        header = struct.pack("<BBBBBBHB", len(payload), 0, 0, self.sequence, self.system, 191,
                             message & 0xFFFF, message >> 16)
        self.sequence = (self.sequence + 1) % 256
        crc = checksum(header + payload + bytes([extra]))
        self.link.sendto(b"\xfd" + header + payload + struct.pack("<H", crc), self.address)

    def take(self, frame):
        length, message = frame[1], int.from_bytes(frame[7:10], "little")
        if message not in MESSAGES:
            return
        extra, layout, names = MESSAGES[message]
        if checksum(frame[1:10 + length] + bytes([extra])) != int.from_bytes(
                frame[10 + length:12 + length], "little"):
            return
        self.system = frame[5]
        size = struct.calcsize(layout)
        payload = frame[10:10 + length].ljust(size, b"\0")[:size]
        self.last[message] = dict(zip(names.split(), struct.unpack(layout, payload)))
        if message == TEXT:
            print(f"{time.monotonic():.3f} {self.last[TEXT]['text'].rstrip(bytes(1)).decode()}")

    def listen(self, seconds):
        """Takes what arrives for so long."""
        until = time.monotonic() + seconds
        while True:
            if self.address and time.monotonic() >= self.heartbeat_at:
                self.heartbeat_at = time.monotonic() + 1.0
                self.send(HEARTBEAT, 0, 18, 8, 0, 4, 3)
            left = until - time.monotonic()
            if left <= 0:
                return
            self.link.settimeout(left)
            try:
                data, self.address = self.link.recvfrom(4096)
            except TimeoutError:
                return
            if data[0] == 0xFD:
                self.take(data)

    def command(self, command, p1=0.0, p2=0.0, p7=math.nan):
        self.last.pop(ACK, None)
        # Of a place or a yaw, the present one.
        nan = 0.0 if self.is_ardupilot else math.nan
        self.send(COMMAND, p1, p2, 0.0, nan, nan, nan, p7, command, self.system, 1, 0)
        while self.last.get(ACK, {}).get("command") != command:
            self.listen(0.02)
        return self.last[ACK]["result"] == 0

    def set_velocity(self, vx, vy, vz):
        self.send(SET_POINT, 0, 0, 0, 0, vx, vy, vz, 0, 0, 0, 0, 0, VELOCITY_ONLY, self.system, 1, 1)

    @property
    def is_ardupilot(self):
        return self.last[HEARTBEAT]["autopilot"] == ARDUPILOT

    @property
    def position(self):
        p = self.last[POSITION]
        return (p["x"], p["y"], p["z"]), (p["vx"], p["vy"], p["vz"])


def plan(position, velocity, goal, limit=2.0, lag_s=0.35, horizon_s=0.8, steps=50):
    """The velocity that ends nearest to the goal, if the vehicle follows it with a lag."""
    best = (math.inf, (0.0, 0.0))
    dt = horizon_s / steps
    for i in range(-20, 21):
        for k in range(-20, 21):
            cx, cy = i * limit / 20, k * limit / 20
            x, y, vx, vy = position[0], position[1], velocity[0], velocity[1]
            for _ in range(steps):
                vx += (cx - vx) * dt / lag_s
                vy += (cy - vy) * dt / lag_s
                x += vx * dt
                y += vy * dt
            cost = math.hypot(goal[0] - x, goal[1] - y) + 0.1 * math.hypot(vx, vy)
            best = min(best, (cost, (cx, cy)))
    return best[1]


def fly_to(controller, goal, limit_s=12.0):
    """Whether it was within 0.25 m of the goal for half a second, in time."""
    begun, there_since = time.monotonic(), None
    while time.monotonic() - begun < limit_s:
        loop_began = time.monotonic()
        position, velocity = controller.position
        vx, vy = plan(position, velocity, goal)
        controller.set_velocity(vx, vy, 1.0 * (goal[2] - position[2]))
        if math.dist(position, goal) > 0.25:
            there_since = None
        elif there_since is None:
            there_since = time.monotonic()
        elif time.monotonic() - there_since > 0.5:
            return True
        controller.listen(max(0.001, PERIOD_S - (time.monotonic() - loop_began)))
    return False


def main():
    side = float(sys.argv[1]) if len(sys.argv) > 1 else 3.0
    height = float(sys.argv[2]) if len(sys.argv) > 2 else 1.5
    controller = FlightController()
    while HEARTBEAT not in controller.last:
        controller.listen(0.1)
    for message, rate_hz in ((POSITION, 30), (STATE, 5)):
        controller.command(SET_INTERVAL, message, 1e6 / rate_hz)
    while POSITION not in controller.last or controller.last.get(STATE, {}).get("landed_state") != 1:
        controller.listen(0.1)
    # ArduPilot takes off in the mode in which it follows set-points, GUIDED, to the height it is given.
    guided, height_of_takeoff = controller.is_ardupilot, math.nan
    if guided:
        height_of_takeoff = height + 1.0
        if not controller.command(SET_MODE, 1, 4):
            return 1
    if not controller.command(ARM, 1.0) or not controller.command(TAKE_OFF, p7=height_of_takeoff):
        return 1
    while controller.position[0][2] > -height:
        controller.listen(0.05)
    if not guided:
        for _ in range(15):  # OFFBOARD needs a stream of set-points first
            controller.set_velocity(0, 0, 0)
            controller.listen(PERIOD_S)
        if not controller.command(SET_MODE, 1, 6):
            return 1
    corners = [(side, 0), (side, side), (0, side), (0, 0)]
    reached = all(fly_to(controller, (x, y, -height)) for x, y in corners)
    print(f"{time.monotonic():.3f} {'at all corners' if reached else 'a corner was missed'}")
    controller.command(LAND)
    while controller.last[HEARTBEAT]["base_mode"] & 128:
        controller.listen(0.1)
    return 0 if reached else 1


if __name__ == "__main__":
    sys.exit(main())
