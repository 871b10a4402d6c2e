#!/usr/bin/env python3
"""A companion computer's program: delivers parcels by missions, which it uploads again in flight.

At each place, a parcel is added for another one nearby. The flight controller waits there until the
program has compared all tours through the places that are left, and uploaded the fastest one. The
program talks MAVLink 2 over UDP port 14540, and needs nothing but Python. Exit code 0: it was at each
place, and has landed.

usage: mavlink_mission.py [HEIGHT_M]
"""

import itertools
import math
import sys
import time

from mavlink_square import HEARTBEAT, MESSAGES, FlightController

# Those of the mission protocol, beside those of mavlink_square.
MESSAGES |= {
    44: (221, "<HBB", "count system component"),
    46: (11, "<H", "seq"),
    47: (153, "<BBB", "system component type"),
    51: (196, "<HBB", "seq system component"),
    73: (38, "<ffffiifHHBBBBB", "p1 p2 p3 p4 x y z seq command system component frame current goes_on"),
    242: (104, "<iii", "latitude longitude altitude"),
}
COUNT, REACHED, RESULT, REQUEST, ITEM, HOME = 44, 46, 47, 51, 73, 242

WAYPOINT, LAND, TAKE_OFF, MISSION_START, REQUEST_MESSAGE = 16, 21, 22, 300, 512
RELATIVE_ALTITUDE = 6
METRES_PER_DEGREE = 111319.5
PARCELS_AT_FIRST, PARCELS_ADDED = 9, 3


def seconds_for(metres, speed=5.0, acceleration=3.0):
    """From rest to rest."""
    if metres < speed * speed / acceleration:
        return 2.0 * math.sqrt(metres / acceleration)
    return metres / speed + speed / acceleration


class Courier:
    def __init__(self, height):
        self.controller = FlightController()
        self.height = height
        self.left = [(5 * math.cos(a), 5 * math.sin(a)) for a in
                     (2 * math.pi * k / PARCELS_AT_FIRST for k in range(PARCELS_AT_FIRST))]
        self.added = 0
        self.tour, self.first = [], 0  # places, and the item of the first one
        self.place = (0.0, 0.0)

    def has_arrived(self):
        """Whether it is at the next place, where a parcel may be added."""
        self.controller.listen(0.02)
        reached = self.controller.last.pop(REACHED, None)
        if not reached or reached["seq"] != self.first:
            return False
        self.place = self.tour[0]
        self.left.remove(self.place)
        if self.added < PARCELS_ADDED:
            self.added += 1
            angle = 2.4 * self.added
            self.left.append((self.place[0] + 1.5 * math.cos(angle), self.place[1] + 1.5 * math.sin(angle)))
        return True

    def plan(self):
        """The fastest way from here to all places and home, of all that there are."""
        places = [self.place, *self.left, (0.0, 0.0)]
        seconds = [[seconds_for(math.dist(a, b)) for b in places] for a in places]
        home = len(places) - 1
        best = min(itertools.permutations(range(1, home)), default=(), key=lambda tour: sum(
            seconds[a][b] for a, b in zip((0, *tour), (*tour, home))))
        return [places[place] for place in best]

    def upload(self, tour, takes_off):
        controller, last = self.controller, self.controller.last
        home = last[HOME]
        per_metre = 1e7 / METRES_PER_DEGREE
        shrinks = math.cos(math.radians(home["latitude"] * 1e-7))

        def item(command, place, z, goes_on=1):
            north, east = place
            return (0.0, 0.3, 0.0, math.nan, home["latitude"] + round(north * per_metre),
                    home["longitude"] + round(east * per_metre / shrinks), z), (command, goes_on)

        items = [item(TAKE_OFF, (0.0, 0.0), self.height)] if takes_off else []
        items += [item(WAYPOINT, place, self.height, goes_on=0) for place in tour]
        items.append(item(LAND, (0.0, 0.0), 0.0))
        last.pop(RESULT, None)
        controller.send(COUNT, len(items), controller.system, 1)
        while RESULT not in last:
            if asked := last.pop(REQUEST, None):
                values, (command, goes_on) = items[asked["seq"]]
                controller.send(ITEM, *values, asked["seq"], command, controller.system, 1, RELATIVE_ALTITUDE, 0,
                                goes_on)
            controller.listen(0.005)
        self.tour, self.first = tour, int(takes_off)
        return last[RESULT]["type"] == 0

    def deliver(self):
        controller = self.controller
        while HEARTBEAT not in controller.last:
            controller.listen(0.1)
        while HOME not in controller.last:
            controller.command(REQUEST_MESSAGE, HOME)
            controller.listen(0.1)
        if not self.upload(self.plan(), takes_off=True):
            return False
        if not controller.command(400, 1.0) or not controller.command(MISSION_START):
            return False
        while self.left:
            if self.has_arrived() and not self.upload(self.plan(), takes_off=False):
                return False
        while controller.last[HEARTBEAT]["base_mode"] & 128:
            controller.listen(0.1)
        print(f"{time.monotonic():.3f} {self.added + PARCELS_AT_FIRST} parcels delivered")
        return True


if __name__ == "__main__":
    sys.exit(0 if Courier(float(sys.argv[1]) if len(sys.argv) > 1 else 3.0).deliver() else 1)
