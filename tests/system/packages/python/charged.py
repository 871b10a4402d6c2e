#!/usr/bin/python3
"""What is imported before connect() is not charged, what is imported after it is."""

import time

import tether

before_s = time.process_time()
vehicle = tether.connect(preload=False)
start_s = vehicle.now_s()
import cv2  # noqa: E402,F401

imported_s = vehicle.now_s() - start_s
vehicle.finish(True, "", {"before_s": before_s, "start_s": start_s, "imported_s": imported_s})
