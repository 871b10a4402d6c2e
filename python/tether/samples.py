"""Samples, models of sensors and set-points.

Each class has the members of its C struct in the same order; `_abi` makes the struct from the annotations. Lengths
are metres, angles radians. W: world (east, north, up). B: body (ahead, left, up). H: heading, W turned by the yaw
only. S: a sensor (ahead, left, up). C: a camera's optical frame (right, down, ahead).
"""

import ctypes
import enum
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, NamedTuple

Int32 = Annotated[int, ctypes.c_int32]
Int64 = Annotated[int, ctypes.c_int64]
UInt32 = Annotated[int, ctypes.c_uint32]
UInt64 = Annotated[int, ctypes.c_uint64]
Float = Annotated[float, ctypes.c_double]
# What follows the type are members of the struct that say nothing.
PaddedBool = Annotated[bool, ctypes.c_int32, ctypes.c_int32]
PaddedUInt32 = Annotated[int, ctypes.c_uint32, ctypes.c_uint32]
FourFloats = Annotated[tuple[float, ...], ctypes.c_double * 4]


class Kind(enum.IntEnum):
    """Kind of a sensor. UNKNOWN: of a later library, which this package cannot read."""

    UNKNOWN = -1
    CAMERA = 0
    IMU = 1
    RANGE = 2
    DEPTH_CAMERA = 3
    RGBD_CAMERA = 4
    SEGMENTATION_CAMERA = 5
    NAVSAT = 6
    MAGNETOMETER = 7
    BAROMETER = 8
    ODOMETRY = 9
    SCAN = 10
    JOINT_STATE = 11

    @classmethod
    def _missing_(cls, value: object) -> "Kind":
        return cls.UNKNOWN


CAMERAS = frozenset({Kind.CAMERA, Kind.DEPTH_CAMERA, Kind.RGBD_CAMERA, Kind.SEGMENTATION_CAMERA})


class Shape(enum.IntEnum):
    """Shape of an anchor."""

    BOX = 0
    CYLINDER = 1
    SPHERE = 2


class Vec3(NamedTuple):
    """A vector; where it is used, unit and frame are named."""

    x: Float
    y: Float
    z: Float


class Quat(NamedTuple):
    """A unit quaternion, Hamilton convention."""

    w: Float
    x: Float
    y: Float
    z: Float


class Pose(NamedTuple):
    """X_PF: pose of a frame F in its parent P; `position_m` is in P, `attitude` is q_PF."""

    position_m: Vec3
    attitude: Quat


@dataclass(frozen=True)
class CameraModel:
    """A pinhole camera with Brown-Conrady distortion (k1, k2, p1, p2, k3, as OpenCV orders them).

    Without distortion, a point (x, y, z) of C is at u = fx * x/z + cx, v = fy * y/z + cy; (0, 0) is the centre of the
    top left pixel.
    """

    width_px: Int32
    height_px: Int32
    fx_px: Float
    fy_px: Float
    cx_px: Float
    cy_px: Float
    k1: Float
    k2: Float
    p1: Float
    p2: Float
    k3: Float


@dataclass(frozen=True)
class ScanModel:
    """Where the rays of a lidar point: `rows` from the lowest elevation, `columns` from the first azimuth.

    What is closer than `min_m` reads -inf, what is farther than `max_m` reads +inf. `sweep_s` is the time from the
    first column to the last, which is measured at `sampled_at_ns`.
    """

    columns: Int32
    rows: Int32
    min_azimuth_rad: Float
    max_azimuth_rad: Float
    min_elevation_rad: Float
    max_elevation_rad: Float
    min_m: Float
    max_m: Float
    sweep_s: Float


@dataclass(frozen=True)
class ImageInfo:
    """ST of the exposure [ns], number of the measurement, and size of an image."""

    sampled_at_ns: Int64
    index: UInt64
    width_px: Int32
    height_px: Int32
    size_bytes: UInt64


@dataclass(frozen=True)
class ScanInfo:
    """ST of a scan's last column [ns], number of the measurement, and how many distances there are."""

    sampled_at_ns: Int64
    index: UInt64
    rays: UInt64


@dataclass(frozen=True)
class ImuSample:
    """Of an inertial measurement unit: w_WS and a - g (+9.81 along "up" at rest), both in S.

    `q_WS` is the attitude from the IMU's own filter; NaN if it has none.
    """

    sampled_at_ns: Int64
    index: UInt64
    angular_velocity_rad_s: Vec3
    specific_force_m_s2: Vec3
    q_WS: Quat


@dataclass(frozen=True)
class RangeSample:
    """Of a rangefinder: the distance along S's x [m]; +inf: nothing in reach; -inf: too close."""

    sampled_at_ns: Int64
    index: UInt64
    range_m: Float


@dataclass(frozen=True)
class NavSatSample:
    """Of a receiver of satellite navigation, in WGS 84. Without a fix, all numbers are NaN.

    The altitude is above the ellipsoid, the velocity is (east, north, up), accuracies are standard deviations.
    """

    sampled_at_ns: Int64
    index: UInt64
    has_fix: PaddedBool
    latitude_deg: Float
    longitude_deg: Float
    altitude_m: Float
    velocity_ENU_m_s: Vec3
    horizontal_accuracy_m: Float
    vertical_accuracy_m: Float
    speed_accuracy_m_s: Float


@dataclass(frozen=True)
class MagnetometerSample:
    """Of a magnetometer: the magnetic flux density in S [T]."""

    sampled_at_ns: Int64
    index: UInt64
    field_T: Vec3


@dataclass(frozen=True)
class BarometerSample:
    """Of a barometer: static pressure [Pa], and its altitude in the standard atmosphere (ISO 2533) [m]."""

    sampled_at_ns: Int64
    index: UInt64
    pressure_Pa: Float
    altitude_m: Float


@dataclass(frozen=True)
class OdometrySample:
    """An estimate, not the truth: pose and velocity of S in W, angular velocity in S.

    Standard deviations are along and about W's axes.
    """

    sampled_at_ns: Int64
    index: UInt64
    p_WS: Vec3
    q_WS: Quat
    v_WS_m_s: Vec3
    w_WS_rad_s: Vec3
    position_stddev_m: Vec3
    attitude_stddev_rad: Vec3
    velocity_stddev_m_s: Vec3


@dataclass(frozen=True)
class JointStateSample:
    """The angles of all joints, in the order of Vehicle.joints."""

    sampled_at_ns: Int64
    index: UInt64
    joints: PaddedUInt32
    angles_rad: FourFloats

    def __post_init__(self) -> None:
        object.__setattr__(self, "angles_rad", self.angles_rad[:self.joints])


@dataclass(frozen=True)
class BatterySample:
    """The battery: voltage under load [V], current [A], what is left (0 to 1), and capacity [C = A s]."""

    sampled_at_ns: Int64
    voltage_v: Float
    current_a: Float
    charge: Float
    capacity_c: Float


@dataclass(frozen=True)
class FlightLimits:
    """The most that the UAV can be commanded.

    `rotors` is 0 if it only takes velocities in the heading frame, without a yaw.
    """

    max_rotor_speed_rad_s: Float
    max_thrust_N: Float
    rotors: PaddedUInt32


@dataclass(frozen=True)
class Joint:
    """A joint that turns a part of the UAV with its sensors, as those of a gimbal do: a chain from the body outwards.

    `point_B_m` and `axis_B` are of its axis while all joints are at 0. It turns with `max_rate_rad_s` to the angle that
    was commanded last.
    """

    name: str
    point_B_m: Vec3
    axis_B: Vec3
    min_rad: float
    max_rad: float
    max_rate_rad_s: float


@dataclass(frozen=True)
class Anchor:
    """An object of the world that the SUT knows beforehand; it has to find out where it is.

    `size_m`: of a box its edges along its own axes; of a cylinder diameter, diameter, length; of a sphere three times
    the diameter. `color`: sRGB, each 0 to 1; light and shade change what a camera sees.
    """

    name: str
    shape: Shape
    size_m: Vec3
    color: Vec3


@dataclass(frozen=True)
class Message:
    """A message of another UAV: when it was sent (the sender's ET [ns]) and when it arrived (ST [ns])."""

    sender: str
    data: bytes
    sent_at_ns: int
    arrived_at_ns: int


@dataclass(frozen=True)
class Setpoint:
    """What the flight controller is to do. What is None is not commanded.

    One of: position, also with velocity, or with velocity and acceleration; velocity, also with acceleration;
    acceleration; attitude and thrust; body rates and thrust; rotor speeds. The first three can have a yaw or a yaw
    rate; without, the UAV keeps its yaw. Each can have the angles of all joints; these alone change nothing of the
    flight. Positions are p_WB. With `in_heading`, velocity and acceleration are in H,
    else in W. Yaw is counter-clockwise from east. The thrust is that of all rotors together, along the body's z.
    `after_s`: from when the command takes effect; of the first set-point of a trajectory 0, then increasing.
    """

    position_W_m: Sequence[float] | None = None
    velocity_m_s: Sequence[float] | None = None
    acceleration_m_s2: Sequence[float] | None = None
    yaw_rad: float | None = None
    yaw_rate_rad_s: float | None = None
    q_WB: Sequence[float] | None = None
    rates_B_rad_s: Sequence[float] | None = None
    thrust_N: float | None = None
    rotor_speeds_rad_s: Sequence[float] | None = None
    joints_rad: Sequence[float] | None = None
    in_heading: bool = False
    after_s: float = 0.0
