"""The UAV as its own program sees it."""

import contextlib
import ctypes
import json
import os
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from types import TracebackType
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from ._abi import check, filled, is_there, joints_of, lib, struct_of, to_c, to_ns, to_python
from .errors import InvalidError, need
from .samples import (
    CAMERAS, Anchor, BarometerSample, BatterySample, CameraModel, FlightLimits, ImageInfo, ImuSample, JointStateSample,
    Kind, MagnetometerSample, Message, NavSatSample, OdometrySample, Pose, RangeSample, ScanInfo, ScanModel, Setpoint, Shape,
    Vec3,
)  # fmt: skip

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

T = TypeVar("T")

_NEXT, _LATEST, _IF_AVAILABLE = range(3)


class _Pixels:
    """Memory of an image, as NumPy takes it: an array on it keeps the image."""

    def __init__(self, image: "Image", address: int, shape: tuple[int, ...], kind: str) -> None:
        self.image = image
        self.__array_interface__ = {"version": 3, "shape": shape, "typestr": kind, "data": (address, True)}


class Image:
    """An image in the library's memory, which is not copied.

    It belongs to no vehicle, never changes, and is freed when nothing refers to it or to an array of it: an array
    stays valid for as long as you keep it. Arrays are read-only; copy one to draw into it. They need NumPy.
    """

    def __init__(self, pointer: int) -> None:
        """Of an image of the library, which it frees."""
        self._pointer: int | None = pointer
        info = filled(ImageInfo, lib.tether_image_get_info, pointer)
        assert info is not None
        self.info = info

    def __del__(self) -> None:
        if getattr(self, "_pointer", None) is not None:
            lib.tether_image_free(self._pointer)

    @property
    def sampled_at_ns(self) -> int:
        """ST of the exposure [ns]."""
        return self.info.sampled_at_ns

    @property
    def index(self) -> int:
        """Number of the measurement of this sensor."""
        return self.info.index

    def _array(self, address: int | None, kind: str, *channels: int) -> Any:
        if address is None:
            return None
        pixels = _Pixels(self, address, (self.info.height_px, self.info.width_px, *channels), kind)
        return need("numpy", "python3-numpy", "pixels").asarray(pixels)

    @property
    def rgb(self) -> "NDArray[np.uint8]":
        """Colours, height x width x 3, sRGB in the order R, G, B (OpenCV: cv2.COLOR_RGB2...).

        Raises InvalidError if the camera measures no colours.
        """
        array: NDArray[np.uint8] | None = self._array(lib.tether_image_rgb(self._pointer), "|u1", 3)
        return _required(array, "colours")

    @property
    def depth_m(self) -> "NDArray[np.float32]":
        """Depths along the optical axis [m], height x width.

        +inf: nothing in reach; -inf: too close; NaN: no direction. Raises InvalidError if the camera measures none.
        """
        array: NDArray[np.float32] | None = self._array(lib.tether_image_depth_m(self._pointer), "<f4")
        return _required(array, "depths")

    @property
    def labels(self) -> "NDArray[np.uint16]":
        """Which model each pixel shows (Sensor.label_models), height x width; 0: none.

        Raises InvalidError if the camera is no segmentation camera.
        """
        array: NDArray[np.uint16] | None = self._array(lib.tether_image_labels(self._pointer), "<u2")
        return _required(array, "labels")


def _required(array: T | None, what: str) -> T:
    if array is None:
        raise InvalidError(f"the camera measures no {what}")
    return array


@dataclass(frozen=True)
class Scan:
    """Of a lidar: ST of its last column [ns], number, and distances [m], rows x columns of Sensor.scan_model.

    +inf: nothing in reach; -inf: too close. Of each distance, `intensities` has how much of the light comes back; None:
    the simulator does not know.
    """

    sampled_at_ns: int
    index: int
    ranges_m: "NDArray[np.float32]"
    intensities: "NDArray[np.float32] | None" = None


class Sensor(Generic[T]):
    """A sensor of the UAV. Reads return at the ET at which the measurement is available."""

    def __init__(self, vehicle: "Vehicle", pointer: int) -> None:
        """Of a sensor of the library."""
        self._vehicle = vehicle
        self._depth = 1  # of its queue
        self._name: bytes = lib.tether_sensor_name(pointer)
        self.name = self._name.decode()
        self.kind = Kind(lib.tether_sensor_get_kind(pointer))
        #: Rate of a periodic sensor [Hz]; 0: measures on demand.
        self.rate_hz: float = lib.tether_sensor_rate_hz(pointer)
        mounting = struct_of(Pose)()
        check(lib.tether_sensor_mounting(pointer, ctypes.byref(mounting)))
        #: X_BS, while joints are at 0. A camera's S looks along its x.
        self.mounting = to_python(Pose, mounting)
        #: How many of the UAV's joints turn it: the first ones.
        self.joints: int = lib.tether_sensor_joints(pointer)
        #: Optics, of a camera of any kind.
        self.camera_model = filled(CameraModel, lib.tether_sensor_camera_model, pointer) if self.kind in CAMERAS else None
        #: Rays, of a lidar.
        self.scan_model = filled(ScanModel, lib.tether_sensor_scan_model, pointer) if self.kind == Kind.SCAN else None
        least, most = ctypes.c_double(), ctypes.c_double()
        status = lib.tether_sensor_range_limits(pointer, ctypes.byref(least), ctypes.byref(most))
        #: Least and largest distance that a rangefinder, or a camera with depths, can measure [m].
        self.range_limits_m = None if status else (least.value, most.value)
        #: The model of each label, of a segmentation camera.
        self.label_models: dict[int, str] = {}
        while found := lib.tether_sensor_label_model(pointer, len(self.label_models) + 1):
            self.label_models[len(self.label_models) + 1] = found.decode()

    def _read(self, mode: int) -> T | None:
        handle = self._vehicle._handle
        if self.kind in CAMERAS:
            image = ctypes.c_void_p()
            there = is_there(lib.tether_read_camera(handle, self._name, mode, ctypes.byref(image)))
            return Image(image.value or 0) if there else None  # type: ignore[return-value]
        if self.scan_model is not None:
            return self._read_scan(handle, self.scan_model, mode)  # type: ignore[return-value]
        if self.kind not in _READS:
            raise InvalidError(f"this package cannot read {self.name}; install that of the library's version")
        name, sample = _READS[self.kind]
        return filled(sample, getattr(lib, name), handle, self._name, mode)

    def _read_scan(self, handle: int | None, rays: ScanModel, mode: int) -> Scan | None:
        np = need("numpy", "python3-numpy", "scans")
        ranges_m, intensities = (np.empty((rays.rows, rays.columns), "float32") for _ in range(2))
        info = filled(ScanInfo, lib.tether_read_scan_intensities, handle, self._name, mode, ranges_m.ctypes.data,
                      intensities.ctypes.data, ranges_m.size)
        known = None if np.isnan(intensities).any() else intensities
        return None if info is None else Scan(info.sampled_at_ns, info.index, ranges_m, known)

    def read(self) -> T:
        """The newest measurement that was not read, or with a queue the oldest; waits if there is none.

        A sensor that measures on demand measures now.
        """
        return _required(self._read(_NEXT), "such thing")

    def latest(self) -> T:
        """The newest measurement, also if it was read before."""
        return _required(self._read(_LATEST), "such thing")

    def read_if_available(self) -> T | None:
        """As read(), but at once; None if no measurement waits. Of a periodic sensor."""
        return self._read(_IF_AVAILABLE)

    def read_all(self) -> list[T]:
        """All measurements that wait in the queue, from the oldest on; at most as many as it has room for."""
        waiting: list[T] = []
        while len(waiting) < self._depth and (sample := self.read_if_available()) is not None:
            waiting.append(sample)
        return waiting

    def set_queue(self, depth: int) -> None:
        """Lets up to `depth` measurements of a periodic sensor wait, 1 to 4096; reads then get the oldest.

        The queue begins at the first read after it: what was measured before is not in it.
        In free running, only the newest waits; the result says how many had no place.
        """
        if not isinstance(depth, int) or not 1 <= depth <= 4096:
            raise InvalidError(f"'{self.name}' cannot have a queue of {depth} measurements; use 1 to 4096")
        check(lib.tether_set_queue(self._vehicle._handle, self._name, depth))
        self._depth = depth


_READS: dict[Kind, tuple[str, type[Any]]] = {
    Kind.IMU: ("tether_read_imu", ImuSample),
    Kind.RANGE: ("tether_read_range", RangeSample),
    Kind.NAVSAT: ("tether_read_navsat", NavSatSample),
    Kind.MAGNETOMETER: ("tether_read_magnetometer", MagnetometerSample),
    Kind.BAROMETER: ("tether_read_barometer", BarometerSample),
    Kind.ODOMETRY: ("tether_read_odometry", OdometrySample),
    Kind.JOINT_STATE: ("tether_read_joint_state", JointStateSample),
}


class _Stage:
    """Marks what is computed within it."""

    def __init__(self, handle: int | None, name: str) -> None:
        self._handle, self._name = handle, name.encode()

    def __enter__(self) -> None:
        check(lib.tether_stage_begin(self._handle, self._name))

    def __exit__(self, *error: object) -> None:
        status = lib.tether_stage_end(self._handle)
        if error[0] is None:
            check(status)


class Vehicle:
    """The UAV. `connect()` makes it; use it by `with`, or close() it.

    Reads, commands, sleeps, messages and finish() are interactions: they can wait, and ET stands still meanwhile.
    Times are ET (execution time) or ST (simulated time). Threads may call it in parallel under tether-exec only.
    """

    def __init__(self, handle: int) -> None:
        """Of a vehicle of the library, which it closes."""
        self._handle: int | None = handle
        self.name: str = lib.tether_uav_name(handle).decode()
        #: Whether the program runs under tether-exec, which measures all of its threads and processes together.
        self.is_concurrent = bool(lib.tether_is_concurrent(handle))
        #: All sensors, in the order of the UAV's model.
        self.sensors: tuple[Sensor[Any], ...] = tuple(
            Sensor(self, lib.tether_sensor_at(handle, i)) for i in range(lib.tether_sensor_count(handle)))
        self.anchors: tuple[Anchor, ...] = tuple(
            _anchor(lib.tether_anchor_at(handle, i)) for i in range(lib.tether_anchor_count(handle)))
        #: Names of the other UAVs.
        self.peers: tuple[str, ...] = tuple(
            lib.tether_peer_at(handle, i).decode() for i in range(lib.tether_peer_count(handle)))
        limits = filled(FlightLimits, lib.tether_get_flight_limits, handle)
        assert limits is not None
        self.flight_limits = limits
        #: The joints that it can command.
        self.joints = joints_of(handle)

    def __enter__(self) -> "Vehicle":
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Closes the connection. Images stay valid. A run whose program did not finish() before fails."""
        handle, self._handle = self._handle, None
        lib.tether_disconnect(handle)

    # ---- What it knows beforehand ----

    def sensor(self, sensor: str | int) -> Sensor[Any]:
        """A sensor by its name, or by its index among all sensors."""
        return self._find(sensor, frozenset(Kind))

    def camera(self, sensor: str | int = 0) -> Sensor[Image]:
        """A camera of any kind, by its name or its index among the cameras."""
        return self._find(sensor, CAMERAS)

    def imu(self, sensor: str | int = 0) -> Sensor[ImuSample]:
        """An inertial measurement unit, by its name or its index among these."""
        return self._find(sensor, {Kind.IMU})

    def range(self, sensor: str | int = 0) -> Sensor[RangeSample]:
        """A rangefinder, by its name or its index among these."""
        return self._find(sensor, {Kind.RANGE})

    def navsat(self, sensor: str | int = 0) -> Sensor[NavSatSample]:
        """A receiver of satellite navigation, by its name or its index among these."""
        return self._find(sensor, {Kind.NAVSAT})

    def magnetometer(self, sensor: str | int = 0) -> Sensor[MagnetometerSample]:
        """A magnetometer, by its name or its index among these."""
        return self._find(sensor, {Kind.MAGNETOMETER})

    def barometer(self, sensor: str | int = 0) -> Sensor[BarometerSample]:
        """A barometer, by its name or its index among these."""
        return self._find(sensor, {Kind.BAROMETER})

    def odometry(self, sensor: str | int = 0) -> Sensor[OdometrySample]:
        """A source of odometry, by its name or its index among these."""
        return self._find(sensor, {Kind.ODOMETRY})

    def joint_state(self, sensor: str | int = 0) -> Sensor[JointStateSample]:
        """The sensor of the angles of all joints, which every UAV with joints has."""
        return self._find(sensor, {Kind.JOINT_STATE})

    def scan(self, sensor: str | int = 0) -> Sensor[Scan]:
        """A lidar, by its name or its index among these."""
        return self._find(sensor, {Kind.SCAN})

    def _find(self, wanted: str | int, kinds: Iterable[Kind]) -> Sensor[Any]:
        fitting = [sensor for sensor in self.sensors if sensor.kind in kinds]
        for index, sensor in enumerate(fitting):
            if wanted in (index, sensor.name):
                return sensor
        raise InvalidError(f"{self.name} has no such sensor: {wanted!r}. It has: " +
                           (", ".join(f"{sensor.name} ({sensor.kind.name})" for sensor in self.sensors) or "none"))

    def anchor(self, name: str) -> Anchor:
        """An anchor by its name."""
        for anchor in self.anchors:
            if anchor.name == name:
                return anchor
        raise InvalidError(f"there is no anchor {name!r}. There are: {', '.join(a.name for a in self.anchors) or 'none'}")

    # ---- Flying ----

    def read_together(self, *cameras: Sensor[Image]) -> tuple[Image, ...]:
        """An image of each camera, all of one instant. The cameras need one rate and phase, and a queue."""
        names = (ctypes.c_char_p * len(cameras))(*(camera._name for camera in cameras))
        images = (ctypes.c_void_p * len(cameras))()
        check(lib.tether_read_together(self._handle, names, len(cameras), images))
        return tuple(Image(image) for image in images if image is not None)

    def read_battery(self) -> BatterySample:
        """The battery now. Raises InvalidError if the UAV has none."""
        return _required(filled(BatterySample, lib.tether_read_battery, self._handle), "such thing")

    def command_velocity(self, ahead_m_s: float = 0.0, left_m_s: float = 0.0, up_m_s: float = 0.0,
                         yaw_rate_rad_s: float = 0.0) -> None:
        """Flies with this velocity in H until the next command; the yaw rate is counter-clockwise seen from above."""
        check(lib.tether_command_velocity(self._handle, ahead_m_s, left_m_s, up_m_s, yaw_rate_rad_s))

    def command(self, setpoint: Setpoint) -> None:
        """Follows a set-point until the next command."""
        self.follow([setpoint])

    def follow(self, setpoints: Sequence[Setpoint]) -> None:
        """Follows a trajectory of 1 to 1024 set-points, each until the time of the next one.

        Raises InvalidError for a list of another length than the UAV's, or a time that is none.
        """
        counts = {"rotor_speeds_rad_s": self.flight_limits.rotors, "joints_rad": len(self.joints)}
        c = [to_c(setpoint, counts) for setpoint in setpoints]
        array = (_C_SETPOINT * len(c))(*c)
        check(lib.tether_follow(self._handle, array, len(c), ctypes.sizeof(_C_SETPOINT)))

    # ---- Time ----

    def now_ns(self) -> int:
        """ET [ns]. Between two calls it grows by what the program computed."""
        now: int = lib.tether_now(self._handle)
        return now

    def now_s(self) -> float:
        """ET [s]."""
        return self.now_ns() * 1e-9

    def sleep_for(self, duration_s: float) -> None:
        """Waits in simulation [s]. Use it in place of time.sleep()."""
        check(lib.tether_sleep_for(self._handle, to_ns(duration_s)))

    def sleep_until(self, et_s: float) -> None:
        """Waits in simulation until an ET [s]; if it has passed, returns at once."""
        check(lib.tether_sleep_until(self._handle, to_ns(et_s)))

    # ---- Messages and reports ----

    def send(self, data: bytes, to: str | None = None) -> None:
        """Sends up to 65536 bytes by radio to another UAV, or to all others."""
        check(lib.tether_send(self._handle, None if to is None else to.encode(), data, len(data)))

    def receive(self, timeout_s: float) -> Message | None:
        """The next message that has arrived, or that arrives within the timeout [s of ET]; None if there is none."""
        pointer = ctypes.c_void_p()
        if not is_there(lib.tether_receive(self._handle, to_ns(timeout_s), ctypes.byref(pointer))):
            return None
        size = ctypes.c_size_t()
        address = lib.tether_message_bytes(pointer, ctypes.byref(size))
        message = Message(lib.tether_message_from(pointer).decode(), ctypes.string_at(address, size.value),
                          lib.tether_message_sent_at(pointer), lib.tether_message_arrived_at(pointer))
        lib.tether_message_free(pointer)
        return message

    def annotate(self, topic: str, data: dict[str, Any]) -> None:
        """Writes an object into the record. Metrics read "roi", "estimate" and "displacement"."""
        check(lib.tether_annotate(self._handle, topic.encode(), _json(data)))

    def stage(self, name: str) -> _Stage:
        """Names what the program computes in a `with`, for `tether timing`."""
        return _Stage(self._handle, name)

    def finish(self, reached_goal: bool, outcome: str = "", details: dict[str, Any] | None = None) -> None:
        """Ends the mission, with a line for a person and the program's own results. Every later call fails."""
        check(lib.tether_finish(self._handle, bool(reached_goal), outcome.encode(), _json(details) if details else b""))


_C_SETPOINT = type(to_c(Setpoint()))


def _anchor(pointer: int) -> Anchor:
    vectors = []
    for function in (lib.tether_anchor_size, lib.tether_anchor_color):
        c = struct_of(Vec3)()
        check(function(pointer, ctypes.byref(c)))
        vectors.append(to_python(Vec3, c))
    return Anchor(lib.tether_anchor_name(pointer).decode(), Shape(lib.tether_anchor_get_shape(pointer)), *vectors)


def _json(data: dict[str, Any]) -> bytes:
    """One JSON object; numbers of NumPy are numbers. Raises InvalidError for NaN, and for what JSON does not have."""
    try:
        return json.dumps(data, allow_nan=False, default=lambda value: value.tolist()).encode()
    except (ValueError, AttributeError) as error:
        raise InvalidError(f"the data cannot be written as JSON: {error}") from error


def connect(*, address: str | None = None, token: str | None = None, uav: str | None = None,
            clock: str | None = None, name: str | None = None,
            timeouts_s: tuple[float, float] | None = None, preload: bool = True) -> Vehicle:
    """Connects to the coordinator as the environment says, which `tether run` sets; arguments replace parts of that.

    With an `address` ("HOST:PORT"), the environment is not used; the clock is "wall" unless `clock` is given.

    ET starts when the coordinator welcomes the program: what was imported and computed before is not charged, what
    follows is. So that the first image does not pay for it, NumPy is imported before, unless `preload` is False.
    `timeouts_s`: for the connection and then for the welcome (10 s and 60 s).
    """
    if preload:
        with contextlib.suppress(ImportError):
            need("numpy", "python3-numpy", "images")
    options = ctypes.c_void_p()
    begin = lib.tether_options_from_environment if address is None else lib.tether_options_new
    check(begin(ctypes.byref(options)))
    try:
        texts = [(lib.tether_options_set_address, address), (lib.tether_options_set_token, token),
                 (lib.tether_options_set_uav, uav), (lib.tether_options_set_clock, clock),
                 (lib.tether_options_set_sut_name, name or os.path.basename(sys.argv[0]) or "python3")]
        for function, text in texts:
            if text is not None:
                check(function(options, text.encode()))
        if timeouts_s is not None:
            check(lib.tether_options_set_timeouts(options, *map(to_ns, timeouts_s)))
        vehicle = ctypes.c_void_p()
        check(lib.tether_connect(options, ctypes.byref(vehicle)))
    finally:
        lib.tether_options_free(options)
    return Vehicle(vehicle.value or 0)


def library_version() -> str:
    """Version of the loaded client library."""
    version: bytes = lib.tether_client_version()
    return version.decode()
