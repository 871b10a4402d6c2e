"""Tether in Python.

A program that flies a UAV begins with `connect()`; a notebook that compares flights with `run()` and `campaign()`.
The guide is docs/guide/python.md. Names carry units and frames: `_s`, `_rad`, `_m`, `_px`, `p_WB` (B's position in W).
"""

from .errors import (
    Code, CommandError, DisconnectedError, InternalError, InvalidError, NoAnswerError, NoMemoryError, ProtocolError,
    RecordError, RefusedError, RunEndedError, TetherError,
)  # fmt: skip
from .record import Record
from .runs import Campaign, Metric, Result, campaign, program, run
from .samples import (
    Anchor, BarometerSample, BatterySample, CameraModel, FlightLimits, ImageInfo, ImuSample, Joint, JointStateSample,
    Kind, MagnetometerSample, Message, NavSatSample, OdometrySample, Pose, Quat, RangeSample, ScanModel, Setpoint, Shape,
    Vec3,
)  # fmt: skip
from .vehicle import Image, Scan, Sensor, Vehicle, connect, library_version

__all__ = [
    "Anchor", "BarometerSample", "BatterySample", "CameraModel", "Campaign", "Code", "CommandError",
    "DisconnectedError", "FlightLimits", "Image", "ImageInfo", "ImuSample", "InternalError", "InvalidError", "Joint",
    "JointStateSample", "Kind", "MagnetometerSample", "Message", "Metric", "NavSatSample", "NoAnswerError", "NoMemoryError",
    "OdometrySample", "Pose", "ProtocolError", "Quat", "RangeSample", "Record", "RecordError", "RefusedError", "Result",
    "RunEndedError", "Scan", "ScanModel", "Sensor", "Setpoint", "Shape", "TetherError", "Vec3", "Vehicle", "campaign",
    "connect", "library_version", "program", "run",
]  # fmt: skip
