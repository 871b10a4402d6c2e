#!/usr/bin/python3
"""Reads the IMU in one thread and the camera in another: a call that waits keeps no other one from running."""

import threading

import tether

with tether.connect() as vehicle:
    camera, imu = vehicle.camera(), vehicle.imu()
    images = []

    def read_images():
        while imu_is_read.is_alive():
            images.append(camera.read().index)

    imu_is_read = threading.Thread(target=lambda: [imu.read() for _ in range(20)])
    reader = threading.Thread(target=read_images)
    imu_is_read.start()
    reader.start()
    reader.join()
    vehicle.finish(vehicle.is_concurrent, "", {"images": len(images)})
