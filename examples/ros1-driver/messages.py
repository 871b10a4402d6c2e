"""Samples of Tether as messages of ROS 1: topics, frames (REP 103 and 105), units and covariances."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import genpy
import numpy as np
import tether
from geometry_msgs.msg import Point, Pose, Quaternion, Transform, TwistStamped, Vector3
from nav_msgs.msg import Odometry
from numpy.typing import NDArray
from sensor_msgs.msg import (
    BatteryState, CameraInfo, FluidPressure, Image, Imu, JointState, LaserScan, MagneticField, NavSatFix, PointCloud2,
    PointField, Range,
)  # fmt: skip
from tether.samples import CAMERAS, Kind, Quat, Vec3

Sensor = tether.Sensor[Any]
OPTICAL_IN_CAMERA = Quat(0.5, -0.5, 0.5, -0.5)  # right, down, ahead in ahead, left, up


class Topic(NamedTuple):
    """Of one sensor. `fill` is called with the sensor, a message with stamp and frame, and the sample."""

    name: str
    type: type[Any]
    frame: str
    fill: Callable[[Sensor, Any, Any], None]


def topics_of(sensor: Sensor, taken: set[str]) -> list[Topic]:
    """By the usual names; with the sensor's name before, if a sensor before has taken them."""
    if sensor.kind in CAMERAS:
        frame, found = sensor.name + "_optical", []
        for kind, folder, fill in _IMAGES:
            if sensor.kind in kind:
                found += [Topic(f"{sensor.name}/{folder}image_raw", Image, frame, fill),
                          Topic(f"{sensor.name}/{folder}camera_info", CameraInfo, frame, fill_camera_info)]
        return found
    if sensor.scan_model is not None and not is_flat(sensor.scan_model):
        found = [Topic("points", PointCloud2, sensor.name, fill_points)]
    else:
        found = [Topic(name, type_, frame or sensor.name, fill) for name, type_, frame, fill in _OTHERS[sensor.kind]]
    if taken & {topic.name for topic in found}:
        found = [topic._replace(name=f"{sensor.name}/{topic.name}") for topic in found]
    taken |= {topic.name for topic in found}
    return found


# ---- Vectors and rotations ----


def vector(v: Vec3) -> Vector3:
    return Vector3(*v)


def quaternion(q: Quat) -> Quaternion:
    return Quaternion(q.x, q.y, q.z, q.w)


def transform(p: Vec3, q: Quat) -> Transform:
    return Transform(vector(p), quaternion(q))


def matrix(q: Quat) -> NDArray[np.float64]:
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def product(a: Quat, b: Quat) -> Quat:
    return Quat(a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w)


def rotation(axis: Vec3, angle_rad: float) -> Quat:
    half = angle_rad / 2
    return Quat(math.cos(half), *(math.sin(half) * component for component in axis))


def is_body(sensor: Sensor) -> bool:
    return sensor.mounting == (Vec3(0, 0, 0), Quat(1, 0, 0, 0))


def body_pose(odometry: Sensor, sample: tether.OdometrySample) -> tuple[Vec3, Quat]:
    """X_WB from the odometry's X_WS."""
    p_BS, q_BS = odometry.mounting
    q_WB = product(sample.q_WS, Quat(q_BS.w, -q_BS.x, -q_BS.y, -q_BS.z))
    return Vec3(*(np.array(sample.p_WS) - matrix(q_WB) @ p_BS)), q_WB


# ---- One function for each message ----


def _fill_image(message: Any, pixels: NDArray[Any], encoding: str) -> None:
    message.height, message.width = pixels.shape[:2]
    message.encoding, message.step, message.data = encoding, pixels.strides[0], pixels.tobytes()


def fill_color(_: Sensor, message: Any, image: tether.Image) -> None:
    _fill_image(message, image.rgb, "rgb8")


def fill_depth(_: Sensor, message: Any, image: tether.Image) -> None:
    _fill_image(message, image.depth_m, "32FC1")


def fill_labels(_: Sensor, message: Any, image: tether.Image) -> None:
    _fill_image(message, image.labels, "mono16")


def fill_camera_info(camera: Sensor, message: Any, _: tether.Image) -> None:
    lens = camera.camera_model
    assert lens is not None
    message.height, message.width, message.distortion_model = lens.height_px, lens.width_px, "plumb_bob"
    message.D = [lens.k1, lens.k2, lens.p1, lens.p2, lens.k3]
    message.K = [lens.fx_px, 0, lens.cx_px, 0, lens.fy_px, lens.cy_px, 0, 0, 1]
    message.R = [1, 0, 0, 0, 1, 0, 0, 0, 1]
    message.P = [lens.fx_px, 0, lens.cx_px, 0, 0, lens.fy_px, lens.cy_px, 0, 0, 0, 1, 0]


def fill_imu(_: Sensor, message: Any, sample: tether.ImuSample) -> None:
    message.angular_velocity = vector(sample.angular_velocity_rad_s)
    message.linear_acceleration = vector(sample.specific_force_m_s2)
    if math.isnan(sample.q_WS.w):
        message.orientation_covariance[0] = -1  # there is none
    else:
        message.orientation = quaternion(sample.q_WS)


def is_flat(rays: tether.ScanModel) -> bool:
    return rays.rows == 1 and rays.min_elevation_rad == 0


def fill_scan(lidar: Sensor, message: Any, scan: tether.Scan) -> None:
    rays = lidar.scan_model
    assert rays is not None
    steps = max(1, rays.columns - 1)
    message.angle_min, message.angle_max = rays.min_azimuth_rad, rays.max_azimuth_rad
    message.angle_increment = (rays.max_azimuth_rad - rays.min_azimuth_rad) / steps
    message.time_increment, message.scan_time = rays.sweep_s / steps, 1 / lidar.rate_hz if lidar.rate_hz else 0
    message.range_min, message.range_max = rays.min_m, rays.max_m
    message.ranges = scan.ranges_m[0].tolist()
    message.intensities = [] if scan.intensities is None else scan.intensities[0].tolist()
    message.header.stamp -= genpy.Duration.from_sec(rays.sweep_s)  # of the first ray


def fill_points(lidar: Sensor, message: Any, scan: tether.Scan) -> None:
    rays = lidar.scan_model
    assert rays is not None
    azimuth = np.linspace(rays.min_azimuth_rad, rays.max_azimuth_rad, rays.columns, dtype=np.float32)
    elevation = np.linspace(rays.min_elevation_rad, rays.max_elevation_rad, rays.rows, dtype=np.float32)[:, None]
    ranges = np.where(np.isfinite(scan.ranges_m), scan.ranges_m, np.float32(np.nan))
    flat = ranges * np.cos(elevation)
    points = [flat * np.cos(azimuth), flat * np.sin(azimuth), ranges * np.sin(elevation)]
    points += [] if scan.intensities is None else [scan.intensities]
    message.fields = [PointField(name, 4 * i, PointField.FLOAT32, 1)
                      for i, name in enumerate(("x", "y", "z", "intensity")[:len(points)])]
    message.height, message.width, message.point_step = rays.rows, rays.columns, 4 * len(points)
    message.row_step = message.width * message.point_step
    message.data = np.stack(points, axis=-1).astype("<f4").tobytes()


def fill_range(finder: Sensor, message: Any, sample: tether.RangeSample) -> None:
    message.radiation_type, message.range = Range.INFRARED, sample.range_m
    message.min_range, message.max_range = finder.range_limits_m or (0, math.inf)


def fill_fix(_: Sensor, message: Any, sample: tether.NavSatSample) -> None:
    message.status.status, message.status.service = 0 if sample.has_fix else -1, 1
    message.latitude, message.longitude, message.altitude = sample.latitude_deg, sample.longitude_deg, sample.altitude_m
    if sample.has_fix:
        east = sample.horizontal_accuracy_m**2
        message.position_covariance = [east, 0, 0, 0, east, 0, 0, 0, sample.vertical_accuracy_m**2]
        message.position_covariance_type = NavSatFix.COVARIANCE_TYPE_DIAGONAL_KNOWN


def fill_fix_velocity(_: Sensor, message: Any, sample: tether.NavSatSample) -> None:
    message.twist.linear = vector(sample.velocity_ENU_m_s)


def fill_field(_: Sensor, message: Any, sample: tether.MagnetometerSample) -> None:
    message.magnetic_field = vector(sample.field_T)


def fill_pressure(_: Sensor, message: Any, sample: tether.BarometerSample) -> None:
    message.fluid_pressure = sample.pressure_Pa


def fill_odometry(odometry: Sensor, message: Any, sample: tether.OdometrySample) -> None:
    """Pose in "odom", and velocities along the own axes, of the sensor: usually the body."""
    in_sensor = matrix(sample.q_WS).T
    message.child_frame_id = "base_link" if is_body(odometry) else odometry.name
    message.pose.pose = Pose(Point(*sample.p_WS), quaternion(sample.q_WS))
    message.pose.covariance = _covariance(np.diag(np.square(sample.position_stddev_m)),
                                          np.diag(np.square(sample.attitude_stddev_rad)))
    message.twist.twist.linear = vector(Vec3(*(in_sensor @ sample.v_WS_m_s)))
    message.twist.twist.angular = vector(sample.w_WS_rad_s)
    velocity = in_sensor @ np.diag(np.square(sample.velocity_stddev_m_s)) @ in_sensor.T
    message.twist.covariance = _covariance(velocity, np.zeros((3, 3)))


def _covariance(linear: NDArray[np.float64], angular: NDArray[np.float64]) -> list[float]:
    covariance = np.zeros((6, 6))
    covariance[:3, :3], covariance[3:, 3:] = linear, angular
    return list(covariance.ravel().tolist())


def fill_joints(_: Sensor, message: Any, sample: tether.JointStateSample) -> None:
    message.position = list(sample.angles_rad)


def fill_battery(message: Any, sample: tether.BatterySample) -> None:
    message.voltage, message.current, message.percentage = sample.voltage_v, -sample.current_a, sample.charge
    message.capacity, message.charge = sample.capacity_c / 3600, sample.charge * sample.capacity_c / 3600
    message.temperature = message.design_capacity = math.nan
    message.power_supply_status, message.present = BatteryState.POWER_SUPPLY_STATUS_DISCHARGING, True


_IMAGES = [
    ({Kind.CAMERA, Kind.RGBD_CAMERA}, "", fill_color),
    ({Kind.DEPTH_CAMERA, Kind.RGBD_CAMERA}, "depth/", fill_depth),
    ({Kind.SEGMENTATION_CAMERA}, "labels/", fill_labels),
]
_OTHERS: dict[Kind, list[tuple[str, type[Any], str, Callable[[Any, Any, Any], None]]]] = {
    Kind.IMU: [("imu/data", Imu, "", fill_imu)],
    Kind.RANGE: [("range", Range, "", fill_range)],
    Kind.NAVSAT: [("fix", NavSatFix, "", fill_fix), ("fix_velocity", TwistStamped, "odom", fill_fix_velocity)],
    Kind.MAGNETOMETER: [("imu/mag", MagneticField, "", fill_field)],
    Kind.BAROMETER: [("pressure", FluidPressure, "", fill_pressure)],
    Kind.ODOMETRY: [("odom", Odometry, "odom", fill_odometry)],
    Kind.SCAN: [("scan", LaserScan, "", fill_scan)],
    Kind.JOINT_STATE: [("joint_states", JointState, "", fill_joints)],
}
