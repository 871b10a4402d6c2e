#!/usr/bin/python3
"""Flies by each kind of command, and reads each kind of sensor: what a flight of python_test.py does.

What is wrong ends it by an exception, and the run by a failure with that as its last line.
"""

import gc
import math
import sys

import numpy as np
import tether
from tether import Setpoint

seen = {}
with tether.connect(name="every_sensor") as vehicle:
    assert [sensor.name for sensor in vehicle.sensors][:2] == ["camera", "imu"], vehicle.sensors
    imu, camera, lidar = vehicle.imu(), vehicle.camera("camera"), vehicle.scan()
    assert vehicle.camera(0) is camera and vehicle.sensor(1) is imu and vehicle.sensor("imu") is imu
    try:
        vehicle.imu("range")
    except tether.InvalidError as error:
        assert error.code == tether.Code.INVALID and "range (RANGE)" in str(error), error
    else:
        raise AssertionError("a rangefinder is no IMU")

    # Set-points of each level.
    limits = vehicle.flight_limits
    assert limits.rotors == 4 and limits.max_thrust_N > 10, limits
    vehicle.command(Setpoint(position_W_m=(1.2, 0.3, 1.3), yaw_rad=0.2))
    vehicle.sleep_until(1.0)
    assert 1.0 <= vehicle.now_s() < 1.1
    vehicle.command(Setpoint(velocity_m_s=(0.2, 0, 0), in_heading=True, yaw_rate_rad_s=0.1))
    vehicle.sleep_for(0.1)
    vehicle.command(Setpoint(acceleration_m_s2=(0, 0, 0)))
    hover_N = limits.max_thrust_N / 3
    vehicle.command(Setpoint(q_WB=(1, 0, 0, 0), thrust_N=hover_N))
    vehicle.command(Setpoint(rates_B_rad_s=(0, 0, 0.1), thrust_N=hover_N))
    vehicle.command(Setpoint(rotor_speeds_rad_s=[400.0] * 4))
    vehicle.follow([Setpoint(position_W_m=(1.2, 0, 1.2)), Setpoint(position_W_m=(1.3, 0, 1.2), after_s=0.5)])
    for wrong in (Setpoint(yaw_rad=1), Setpoint(position_W_m=(float("nan"), 0, 1))):
        try:
            vehicle.command(wrong)
        except tether.InvalidError:
            pass
        else:
            raise AssertionError(f"{wrong} was accepted")

    # A queue: each measurement once, in order.
    imu.set_queue(50)
    imu.read()
    vehicle.sleep_for(0.5)
    waiting = imu.read_all()
    assert [b.index - a.index for a, b in zip(waiting, waiting[1:])] == [1] * (len(waiting) - 1)
    assert 95 <= len(waiting) * 10 <= 110, len(waiting)  # 20 Hz for half a second
    assert imu.read_if_available() is None
    assert imu.latest() == waiting[-1]
    seen["imu"] = waiting[-1].specific_force_m_s2.z
    assert imu.rate_hz == 20 and len(imu.mounting.position_m) == 3

    # Images are views of the library's memory, which is there as long as a view of it is.
    image = camera.read()
    rgb, row = image.rgb, image.rgb[7]
    assert rgb.shape == (camera.camera_model.height_px, camera.camera_model.width_px, 3) and rgb.dtype == np.uint8
    assert not rgb.flags.owndata and not rgb.flags.writeable
    assert image.rgb.ctypes.data == rgb.ctypes.data, "a copy"
    kept = row.copy()
    del image, rgb
    gc.collect()
    for _ in range(3):
        camera.read()
    np.testing.assert_array_equal(row, kept)
    try:
        camera.latest().depth_m
    except tether.InvalidError:
        pass
    else:
        raise AssertionError("a camera without depths has some")

    with vehicle.stage("pairs"):
        rgbd, labels = vehicle.camera("rgbd"), vehicle.camera("labels")
        for of_pair in (rgbd, labels):
            of_pair.set_queue(4)
        with_depth, with_labels = vehicle.read_together(rgbd, labels)
    assert with_depth.sampled_at_ns == with_labels.sampled_at_ns
    assert rgbd.range_limits_m == (0.3, 8.0) and "blue_box" in labels.label_models.values()
    near = with_depth.depth_m[np.isfinite(with_depth.depth_m)]
    assert near.dtype == np.float32 and near.min() >= 0.3 and near.max() <= 8.0
    assert set(np.unique(with_labels.labels)) <= {0, *labels.label_models}

    scan = lidar.read()
    assert scan.ranges_m.shape == (lidar.scan_model.rows, lidar.scan_model.columns) == (1, 90)
    seen["scan_m"] = scan.ranges_m.min()
    # By the colours of the room, as it has no <laser_retro>.
    assert scan.intensities.shape == (1, 90) and scan.intensities.dtype == np.float32
    assert 0 < scan.intensities.min() < scan.intensities.max() <= 1
    range_m = vehicle.range().read().range_m
    assert 0.04 <= range_m <= 4 or range_m == math.inf, range_m
    seen["altitude_m"] = vehicle.barometer().read().altitude_m
    seen["field_T"] = np.linalg.norm(vehicle.magnetometer().read().field_T)
    seen["has_fix"] = vehicle.navsat().read().has_fix
    seen["p_WS"] = vehicle.odometry().read().p_WS
    seen["charge"] = vehicle.read_battery().charge
    seen["anchor"] = vehicle.anchor("blue_box").size_m

    assert vehicle.peers == () and vehicle.receive(0.0) is None
    vehicle.annotate("seen", seen)
    vehicle.finish(True, "seen", {"python": sys.version.split()[0]})
    try:
        imu.read()
    except tether.TetherError:
        pass
    else:
        raise AssertionError("a read after the end of the mission")
try:
    vehicle.read_battery()
except tether.InvalidError:
    sys.exit(0)
raise AssertionError("a read after the connection was closed")
