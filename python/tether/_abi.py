"""The C ABI of libtether-client by ctypes.

`python/test/abi_test.py` compares what is declared here with the C headers, by the C compiler.
"""

import ctypes
import dataclasses
import functools
import os
import pathlib
from collections.abc import Callable
from typing import Any, TypeVar

from . import samples
from .errors import ERRORS, Code, InternalError, InvalidError

T = TypeVar("T")

LIBRARY = "libtether-client.so.1"

_TYPES: dict[str, Any] = {
    "v": None, "p": ctypes.c_void_p, "s": ctypes.c_char_p, "i": ctypes.c_int32, "u": ctypes.c_uint32,
    "h": ctypes.c_uint16, "l": ctypes.c_int64, "z": ctypes.c_size_t, "d": ctypes.c_double,
}

# Result and arguments of each function; the letters are those of _TYPES.
FUNCTIONS = {
    "tether_client_version": "s", "tether_last_error": "s",
    "tether_options_new": "ip", "tether_options_from_environment": "ip", "tether_options_free": "vp",
    "tether_options_set_address": "ips",
    "tether_options_set_token": "ips", "tether_options_set_uav": "ips", "tether_options_set_sut_name": "ips",
    "tether_options_set_clock": "ips", "tether_options_set_timeouts": "ipll",
    "tether_connect": "ipp", "tether_disconnect": "vp", "tether_is_concurrent": "ip",
    "tether_uav_name": "sp", "tether_sensor_count": "zp", "tether_sensor_at": "ppz", "tether_sensor_name": "sp",
    "tether_sensor_get_kind": "ip", "tether_sensor_rate_hz": "dp", "tether_sensor_mounting": "ipp",
    "tether_sensor_camera_model": "ippz", "tether_sensor_scan_model": "ippz", "tether_sensor_range_limits": "ippp",
    "tether_sensor_label_model": "sph",
    "tether_anchor_count": "zp", "tether_anchor_at": "ppz", "tether_anchor_name": "sp",
    "tether_anchor_get_shape": "ip", "tether_anchor_size": "ipp", "tether_anchor_color": "ipp",
    "tether_set_queue": "ipsu", "tether_read_camera": "ipsip", "tether_image_free": "vp",
    "tether_image_get_info": "ippz", "tether_image_rgb": "pp", "tether_image_depth_m": "pp",
    "tether_image_labels": "pp", "tether_read_together": "ippzp",
    "tether_read_imu": "ipsipz", "tether_read_range": "ipsipz", "tether_read_navsat": "ipsipz",
    "tether_read_magnetometer": "ipsipz", "tether_read_barometer": "ipsipz", "tether_read_odometry": "ipsipz",
    "tether_read_joint_state": "ipsipz",
    "tether_read_scan": "ipsipzpz", "tether_read_scan_intensities": "ipsippzpz", "tether_read_battery": "ippz",
    "tether_command_velocity": "ipdddd", "tether_follow": "ippzz", "tether_get_flight_limits": "ippz",
    "tether_joint_count": "zp", "tether_get_joint": "ipzpz", "tether_sensor_joints": "zp",
    "tether_now": "lp", "tether_sleep_for": "ipl", "tether_sleep_until": "ipl",
    "tether_annotate": "ipss", "tether_stage_begin": "ips", "tether_stage_end": "ip", "tether_finish": "ipiss",
    "tether_peer_count": "zp", "tether_peer_at": "spz", "tether_send": "ipspz", "tether_receive": "iplp",
    "tether_message_from": "sp", "tether_message_bytes": "ppp", "tether_message_sent_at": "lp",
    "tether_message_arrived_at": "lp", "tether_message_free": "vp",
}  # fmt: skip


def near(name: str, *folders: str) -> str | None:
    """A file of what holds this package: a checkout, of whose builds the newest counts, or a prefix."""
    for parent in pathlib.Path(__file__).resolve().parents[2:5]:
        for places in ([f"build/{preset}/{folders[0]}" for preset in ("release", "dev", "ci")], folders):
            if found := [file for place in places for file in parent.glob(f"{place}/{name}")]:
                return str(max(found, key=lambda file: file.stat().st_mtime))
    return None


def _load() -> ctypes.CDLL:
    """The library that TETHER_CLIENT_LIBRARY names, else the one near this package, else the system's."""
    path = os.environ.get("TETHER_CLIENT_LIBRARY") or near(LIBRARY, "lib", "lib/*") or LIBRARY
    try:
        return ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(f"{error}. Install Debian's libtether-client1, build the target tether-client, "
                          f"or set TETHER_CLIENT_LIBRARY to the path of {LIBRARY}") from error


class _Library:
    """The functions, loaded when the first one is used: starting runs does not need them."""

    def __getattr__(self, name: str) -> Any:
        library = _load()
        for function, types in FUNCTIONS.items():
            bound = getattr(library, function)
            bound.restype = _TYPES[types[0]]
            bound.argtypes = [_TYPES[letter] for letter in types[1:]]
            setattr(self, function, bound)
        return self.__dict__[name]


lib = _Library()


def check(status: int) -> None:
    """Raises the error of a status that is not TETHER_OK."""
    if status:
        raise ERRORS.get(status, InternalError)(lib.tether_last_error().decode("utf-8", "replace"))


def is_there(status: int) -> bool:
    """Whether a read has a measurement, and not "nothing yet". Raises the error of any other status."""
    if status == Code.NOTHING_YET:
        return False
    check(status)
    return True


# ---- Structs -------------------------------------------------------------------------------------

_STRUCTS: dict[type, type[ctypes.Structure]] = {}
_CONVERSIONS: dict[Any, Callable[[Any], Any]] = {bool: bool, tuple[float, ...]: tuple}
_MEMBERS: dict[type, list[tuple[str, Callable[[Any], Any] | None]]] = {}  # and what makes Python's value, if anything


def struct_of(sample: type) -> type[ctypes.Structure]:
    """The C struct of a class of `samples`."""
    if sample not in _STRUCTS:
        fields: list[tuple[str, Any]] = []
        _MEMBERS[sample] = []
        for name, hint in sample.__annotations__.items():
            first, *padding = getattr(hint, "__metadata__", None) or (struct_of(hint),)
            fields += [(name, first)] + [("reserved", kind) for kind in padding]
            is_struct = hint in _STRUCTS
            convert = functools.partial(to_python, hint) if is_struct else _CONVERSIONS.get(hint.__origin__)
            _MEMBERS[sample].append((name, convert))
        _STRUCTS[sample] = type(sample.__name__, (ctypes.Structure,), {"_fields_": fields})
    return _STRUCTS[sample]


def to_python(sample: type[T], struct: Any) -> T:
    """The members of a struct as an object of its class."""
    return sample(*[getattr(struct, name) if convert is None else convert(getattr(struct, name))
                    for name, convert in _MEMBERS[sample]])


def filled(sample: type[T], function: Callable[..., int], *arguments: Any) -> T | None:
    """What a function gives that fills a struct of that size; None: nothing yet."""
    struct = struct_of(sample)()
    status = function(*arguments, ctypes.byref(struct), ctypes.sizeof(struct))
    return to_python(sample, struct) if is_there(status) else None


class CSetpoint(ctypes.Structure):
    """A set-point, with the mask of what is commanded."""

    _fields_ = [
        ("after_ns", ctypes.c_int64), ("mask", ctypes.c_uint32), ("in_heading", ctypes.c_uint32),
        ("position_W_m", struct_of(samples.Vec3)), ("velocity_m_s", struct_of(samples.Vec3)),
        ("acceleration_m_s2", struct_of(samples.Vec3)), ("yaw_rad", ctypes.c_double),
        ("yaw_rate_rad_s", ctypes.c_double), ("q_WB", struct_of(samples.Quat)),
        ("rates_B_rad_s", struct_of(samples.Vec3)), ("thrust_N", ctypes.c_double),
        ("rotor_speeds_rad_s", ctypes.c_double * 8), ("rotors", ctypes.c_uint32), ("joints", ctypes.c_uint32),
        ("joints_rad", ctypes.c_double * 4),
    ]  # fmt: skip


MASK = {"position_W_m": 1, "velocity_m_s": 2, "acceleration_m_s2": 4, "yaw_rad": 8, "yaw_rate_rad_s": 16, "q_WB": 32,
        "rates_B_rad_s": 64, "thrust_N": 128, "rotor_speeds_rad_s": 256, "joints_rad": 512}  # fmt: skip
COUNTS = {"rotor_speeds_rad_s": "rotors", "joints_rad": "joints"}


class CJoint(ctypes.Structure):
    """A joint of the UAV."""

    _fields_ = [
        ("name", ctypes.c_char_p), ("point_B_m", struct_of(samples.Vec3)), ("axis_B", struct_of(samples.Vec3)),
        ("min_rad", ctypes.c_double), ("max_rad", ctypes.c_double), ("max_rate_rad_s", ctypes.c_double),
    ]  # fmt: skip


def joints_of(handle: int | None) -> tuple[samples.Joint, ...]:
    """The joints of a vehicle."""
    joints = []
    for index in range(lib.tether_joint_count(handle)):
        c = CJoint()
        check(lib.tether_get_joint(handle, index, ctypes.byref(c), ctypes.sizeof(c)))
        point, axis = (to_python(samples.Vec3, vector) for vector in (c.point_B_m, c.axis_B))
        joints.append(samples.Joint(c.name.decode(), point, axis, c.min_rad, c.max_rad, c.max_rate_rad_s))
    return tuple(joints)


def to_c(setpoint: samples.Setpoint, counts: dict[str, int] | None = None) -> CSetpoint:
    """The struct of a set-point. Raises InvalidError for a vector of another length; `counts`: of the UAV's lists."""
    c = CSetpoint(after_ns=to_ns(setpoint.after_s), in_heading=setpoint.in_heading)
    for field in dataclasses.fields(setpoint):
        value = getattr(setpoint, field.name)
        if field.name not in MASK or value is None:
            continue
        c.mask |= MASK[field.name]
        if field.name in COUNTS:
            most = len(getattr(c, field.name))
            needed = (counts or {}).get(field.name) or None
            if len(value) > most or (needed is not None and len(value) != needed):
                raise InvalidError(f"{field.name} has {len(value)} numbers; the UAV has "
                                   f"{needed or f'at most {most}'} {COUNTS[field.name]}")
            setattr(c, COUNTS[field.name], len(value))
            getattr(c, field.name)[:len(value)] = [float(number) for number in value]
        elif isinstance(member := getattr(c, field.name), ctypes.Structure):
            if len(value) != len(member._fields_):
                raise InvalidError(f"{field.name} has {len(value)} numbers instead of {len(member._fields_)}")
            setattr(c, field.name, type(member)(*map(float, value)))
        else:
            setattr(c, field.name, float(value))
    return c


def to_ns(seconds: float) -> int:
    """Whole nanoseconds of seconds. Raises InvalidError for NaN, and beyond what 64 bits hold."""
    if not abs(seconds) < 9.2e9:
        raise InvalidError(f"a time must be a number of seconds, but is {seconds}")
    return round(seconds * 1e9)
