#!/usr/bin/python3
"""Turns the UAV towards an anchor, with OpenCV and Tether's package for Python.

`tether run face_anchor.toml` starts it. Exit code: 0 if it faces the anchor, 1 if it does not.
"""

import argparse
import colorsys
import math
import sys

import cv2
import numpy as np
import tether
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]

PRECISION_RAD = math.radians(2.0)
FASTEST_RAD_S = math.radians(25.0)
GAIN_PER_S = 1.6
IMAGES_IN_A_ROW = 3
TIME_LIMIT_S = 8.0  # execution time, as every time here

cv2.setNumThreads(1)  # the clock "cpu" adds up what parallel threads compute


class Moments:
    """Mean column of the pixels that have the anchor's hue: cheap."""

    def __init__(self, color: tether.Vec3) -> None:
        hue = colorsys.rgb_to_hsv(*color)[0] * 180
        self.least, self.most = (hue - 10, 80, 40), (hue + 10, 255, 255)

    def column_px(self, rgb: Pixels) -> float | None:
        found = cv2.moments(cv2.inRange(cv2.cvtColor(rgb, cv2.COLOR_RGB2HSV), self.least, self.most), True)
        return found["m10"] / found["m00"] if found["m00"] > rgb.shape[0] * rgb.shape[1] / 5000 else None


class CamShift(Moments):
    """Window that follows the anchor's hue through images without noise: expensive."""

    window: tuple[int, int, int, int] | None = None

    def column_px(self, rgb: Pixels) -> float | None:
        hsv = cv2.cvtColor(cv2.medianBlur(rgb, 9), cv2.COLOR_RGB2HSV)
        likely = cv2.inRange(hsv, self.least, self.most)
        if not likely.any():
            self.window = None
            return None
        self.window = self.window or cv2.boundingRect(likely)
        stop = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 10, 1)
        box, self.window = cv2.CamShift(likely, self.window, stop)
        if not all(box[1]):
            self.window = None
            return None
        return float(box[0][0])


TRACKERS = {"moments": Moments, "camshift": CamShift}


def face(vehicle: tether.Vehicle, tracker: Moments, anchor: str) -> bool:
    """Turns until the UAV faces the anchor; False after the time limit."""
    camera = vehicle.camera("camera")
    lens = camera.camera_model
    assert lens is not None
    begun_s, in_a_row, yaw_rate_rad_s = vehicle.now_s(), 0, FASTEST_RAD_S
    while vehicle.now_s() - begun_s < TIME_LIMIT_S:
        image = camera.read()
        with vehicle.stage("track"):
            column_px = tracker.column_px(image.rgb)
        if column_px is not None:
            bearing_rad = math.atan((lens.cx_px - column_px) / lens.fx_px)
            yaw_rate_rad_s = max(-FASTEST_RAD_S, min(FASTEST_RAD_S, GAIN_PER_S * bearing_rad))
            in_a_row = in_a_row + 1 if abs(bearing_rad) < PRECISION_RAD else 0
            vehicle.annotate("estimate", {
                "anchor": anchor, "camera": camera.name, "image_index": image.index, "bearing_rad": bearing_rad,
                "distance_m": None, "converged": in_a_row == IMAGES_IN_A_ROW})
        if in_a_row == IMAGES_IN_A_ROW:
            vehicle.command_velocity()
            vehicle.sleep_for(0.5)
            return True
        vehicle.command_velocity(yaw_rate_rad_s=yaw_rate_rad_s)
    return False


def main() -> int:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--anchor", default="blue_box")
    options.add_argument("--tracker", choices=TRACKERS, default="camshift")
    chosen = options.parse_args()
    with tether.connect() as vehicle:
        tracker = TRACKERS[chosen.tracker](vehicle.anchor(chosen.anchor).color)
        reached = face(vehicle, tracker, chosen.anchor)
        vehicle.finish(reached, "faces the anchor" if reached else "time limit", {"tracker": chosen.tracker})
    return 0 if reached else 1


if __name__ == "__main__":
    sys.exit(main())
