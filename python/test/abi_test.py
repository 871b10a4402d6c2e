"""What `tether._abi` declares is what the C headers declare, as the C compiler reads them."""

import ctypes
import pathlib
import re
import subprocess
import unittest

from tether import _abi, errors, samples

ROOT = pathlib.Path(__file__).resolve().parents[2] / "target/client/c_api"
HEADER = "#include <tether/client.h>\n"

STRUCTS = {
    "tether_vec3": samples.Vec3, "tether_quat": samples.Quat, "tether_pose": samples.Pose,
    "tether_camera_model": samples.CameraModel, "tether_scan_model": samples.ScanModel,
    "tether_image_info": samples.ImageInfo, "tether_scan_info": samples.ScanInfo,
    "tether_imu_sample": samples.ImuSample, "tether_range_sample": samples.RangeSample,
    "tether_navsat_sample": samples.NavSatSample, "tether_magnetometer_sample": samples.MagnetometerSample,
    "tether_barometer_sample": samples.BarometerSample, "tether_odometry_sample": samples.OdometrySample,
    "tether_joint_state_sample": samples.JointStateSample, "tether_battery_sample": samples.BatterySample, "tether_flight_limits": samples.FlightLimits,
}  # fmt: skip
# Callbacks are not for an interpreter that one thread at a time may use; the others have a counterpart that is bound.
NOT_BOUND = re.compile("tether_(subscri|unsubscribe|on_|scan$|client_abi_version|status_name|image_copy|"
                       "read_camera_into|find_)")  # fmt: skip
C_TYPES = {ctypes.c_int32: "int32_t", ctypes.c_int64: "int64_t", ctypes.c_uint32: "uint32_t",
           ctypes.c_uint64: "uint64_t", ctypes.c_double: "double", ctypes.c_char_p: "const char*"}  # fmt: skip


def compiled(source, *options):
    """What the compiler says to a C program, and what it prints."""
    return subprocess.run(["cc", "-std=c11", "-xc", f"-I{ROOT / 'include'}", *options, "-"], text=True,
                          input=HEADER + source, capture_output=True)


def declared():
    """The headers without comments, macros and line breaks."""
    return " ".join(compiled("", "-E", "-P").stdout.split())


def letter(declaration):
    """The letter of _abi.FUNCTIONS for the declaration of an argument, or the type of a result."""
    if "*" in declaration or declaration.startswith("tether_on_"):
        return "s" if re.fullmatch(r"const char ?\*( ?\w+)?", declaration) else "p"
    letters = {"void": "v", "uint32_t": "u", "uint16_t": "h", "int64_t": "l", "size_t": "z", "double": "d",
               **dict.fromkeys(("int32_t", "tether_status", "tether_sensor_kind", "tether_anchor_shape",
                                "tether_read_mode"), "i")}
    return letters[declaration.split()[0]]


def functions():
    """{name: letters} of the headers."""
    found = re.findall(r"((?:const )?\w+ ?\*?) ?\b(tether_\w+)\(([^()]*)\) ?;", declared())
    return {name: "".join(map(letter, [result, *([] if arguments == "void" else re.split(", ?", arguments))]))
            for result, name, arguments in found}


def assertions(c_name, struct):
    """A struct of ctypes as static assertions in C."""
    lines = [f'_Static_assert(sizeof({c_name}) == {ctypes.sizeof(struct)}, "size of {c_name}");']
    names = {_abi.struct_of(sample): name for name, sample in STRUCTS.items()}
    for field, kind in struct._fields_:
        size, offset = ctypes.sizeof(kind), getattr(struct, field).offset
        is_array = hasattr(kind, "_length_")
        c_type = {**C_TYPES, **names}[kind._type_ if is_array else kind]
        member = f"(({c_name}*)0)->{field}"
        lines += [f'_Static_assert(offsetof({c_name}, {field}) == {offset}, "{field}");',
                  f'_Static_assert(sizeof({member}) == {size}, "{field}");',
                  f'_Static_assert(_Generic({member}{"[0]" if is_array else ""}, {c_type}: 1, default: 0), "{field}");']
    return "\n".join(lines)


class Abi(unittest.TestCase):
    def expect_same(self, c_name, struct):
        told = compiled(assertions(c_name, struct), "-fsyntax-only").stderr
        self.assertEqual(told, "", c_name)

    def test_structs_are_laid_out_alike(self):
        for c_name, sample in STRUCTS.items():
            self.expect_same(c_name, _abi.struct_of(sample))
        self.expect_same("tether_setpoint", _abi.CSetpoint)
        self.expect_same("tether_joint", _abi.CJoint)

    def test_a_planted_difference_is_found(self):
        class Swapped(ctypes.Structure):
            _fields_ = [("sampled_at_ns", ctypes.c_int64), ("index", ctypes.c_uint64), ("altitude_m", ctypes.c_double),
                        ("pressure_Pa", ctypes.c_double)]

        class OtherType(ctypes.Structure):
            _fields_ = [("sampled_at_ns", ctypes.c_int64), ("index", ctypes.c_uint64), ("range_m", ctypes.c_int64)]

        self.assertIn("pressure_Pa", compiled(assertions("tether_barometer_sample", Swapped), "-fsyntax-only").stderr)
        self.assertIn("range_m", compiled(assertions("tether_range_sample", OtherType), "-fsyntax-only").stderr)

    def test_no_struct_and_no_function_is_left_out(self):
        defined = set(re.findall(r"typedef struct (\w+) \{", declared()))
        self.assertGreater(len(defined), 15)
        bound = {*STRUCTS, "tether_setpoint", "tether_joint"}
        self.assertEqual({name for name in defined if not NOT_BOUND.match(name)}, bound)
        symbols = {line.split("@")[0] for line in (ROOT / "abi/symbols.txt").read_text().splitlines()
                   if line.startswith("tether_")}
        self.assertEqual(set(functions()), symbols)
        self.assertEqual({name for name in symbols if not NOT_BOUND.match(name)}, set(_abi.FUNCTIONS))

    def test_functions_have_the_same_arguments(self):
        of_header = functions()
        for name, letters in _abi.FUNCTIONS.items():
            self.assertEqual(letters, of_header[name], name)

    def test_constants_are_the_same(self):
        constants = {
            **{f"TETHER_{code.name}": code for code in errors.Code},
            **{f"TETHER_{kind.name}": kind for kind in samples.Kind if kind >= 0},
            **{f"TETHER_{shape.name}": shape for shape in samples.Shape},
            **dict(zip(("TETHER_READ_NEXT", "TETHER_READ_LATEST", "TETHER_READ_IF_AVAILABLE"), range(3))),
        }
        bits = ("POSITION", "VELOCITY", "ACCELERATION", "YAW", "YAW_RATE", "ATTITUDE", "BODY_RATES", "THRUST",
                "ROTOR_SPEEDS", "JOINTS")
        constants |= {f"TETHER_{name}": bit for name, bit in zip(bits, _abi.MASK.values(), strict=True)}
        checks = [f'_Static_assert({name} == {int(value)}, "{name}");' for name, value in constants.items()]
        self.assertEqual(compiled("\n".join(checks), "-fsyntax-only").stderr, "")
        named = set(re.findall(r"\b(TETHER_[A-Z_]+) = ", declared()))
        self.assertEqual(named, set(constants))

    def test_each_status_has_an_error(self):
        self.assertEqual({*errors.ERRORS, errors.Code.OK, errors.Code.NOTHING_YET}, set(errors.Code))
        for code, error in errors.ERRORS.items():
            self.assertEqual(error.code, code)


if __name__ == "__main__":
    unittest.main()
