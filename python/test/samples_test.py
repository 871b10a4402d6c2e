"""Set-points and samples between Python and C."""

import math
import unittest

from tether import _abi, samples, vehicle
from tether.errors import InvalidError
from tether.samples import Setpoint, Vec3


class Setpoints(unittest.TestCase):
    def test_the_mask_is_what_is_given(self):
        for setpoint, mask in {
            Setpoint(): 0,
            Setpoint(position_W_m=(1, 2, 3), yaw_rad=0.5): 1 + 8,
            Setpoint(velocity_m_s=Vec3(1, 0, 0), acceleration_m_s2=(0, 0, 1), yaw_rate_rad_s=0): 2 + 4 + 16,
            Setpoint(q_WB=(1, 0, 0, 0), thrust_N=5): 32 + 128,
            Setpoint(rates_B_rad_s=(0, 0, 1), thrust_N=5): 64 + 128,
            Setpoint(rotor_speeds_rad_s=(1, 2, 3, 4)): 256,
            Setpoint(joints_rad=(0.5, -1)): 512,
        }.items():
            self.assertEqual(_abi.to_c(setpoint).mask, mask, setpoint)

    def test_values_arrive(self):
        c = _abi.to_c(Setpoint(position_W_m=(1, 2, 3), yaw_rad=0.5, in_heading=True, after_s=0.1))
        self.assertEqual((c.position_W_m.x, c.position_W_m.y, c.position_W_m.z), (1, 2, 3))
        self.assertEqual((c.yaw_rad, c.in_heading, c.after_ns), (0.5, 1, 100_000_000))
        c = _abi.to_c(Setpoint(rotor_speeds_rad_s=[10, 20, 30]))
        self.assertEqual((c.rotors, *c.rotor_speeds_rad_s), (3, 10, 20, 30, 0, 0, 0, 0, 0))
        c = _abi.to_c(Setpoint(joints_rad=(0.5, -1)))
        self.assertEqual((c.joints, *c.joints_rad), (2, 0.5, -1, 0, 0))

    def test_vectors_of_another_length_are_refused(self):
        for wrong in (Setpoint(position_W_m=(1, 2)), Setpoint(q_WB=(1, 0, 0)), Setpoint(rotor_speeds_rad_s=range(9))):
            with self.assertRaises(ValueError):
                _abi.to_c(wrong)
        counts = {"rotor_speeds_rad_s": 4, "joints_rad": 0}
        self.assertEqual(_abi.to_c(Setpoint(rotor_speeds_rad_s=(1, 2, 3, 4)), counts).rotors, 4)
        for wrong, told in {Setpoint(rotor_speeds_rad_s=(1, 2, 3)): "has 3 numbers; the UAV has 4 rotors",
                            Setpoint(joints_rad=(0,) * 5): "has 5 numbers; the UAV has at most 4 joints"}.items():
            with self.assertRaisesRegex(ValueError, told):
                _abi.to_c(wrong, counts)

    def test_times_are_numbers(self):
        for wrong in (math.nan, math.inf, 1e10):
            with self.assertRaisesRegex(ValueError, "a time must be a number of seconds, but is"):
                _abi.to_c(Setpoint(velocity_m_s=(1, 0, 0), after_s=wrong))

    def test_a_queue_has_a_depth(self):
        for depth in (-3, 0, 4097):
            with self.assertRaisesRegex(InvalidError, f"a queue of {depth} measurements; use 1 to 4096"):
                FastSensor().set_queue(depth)


class FastSensor(vehicle.Sensor[int]):
    """Has a new measurement at each read, as a fast one before a slow computer."""

    def __init__(self) -> None:
        self.name = "fast"
        self._depth = 1

    def read_if_available(self) -> int | None:
        return 7


class Reads(unittest.TestCase):
    def test_of_all_that_wait_ends_with_what_the_queue_has_room_for(self):
        sensor = FastSensor()
        self.assertEqual(sensor.read_all(), [7])
        sensor._depth = 3
        self.assertEqual(sensor.read_all(), [7, 7, 7])


class Samples(unittest.TestCase):
    def test_a_struct_becomes_an_object_of_its_class(self):
        c = _abi.struct_of(samples.NavSatSample)(7, 3, 1, 0, 50.0, 8.0, 300.0)
        c.velocity_ENU_m_s.y = 2.0
        sample = _abi.to_python(samples.NavSatSample, c)
        self.assertEqual((sample.sampled_at_ns, sample.index, sample.has_fix), (7, 3, True))
        self.assertIs(type(sample.has_fix), bool)
        self.assertEqual((sample.latitude_deg, sample.longitude_deg, sample.altitude_m), (50.0, 8.0, 300.0))
        self.assertEqual(sample.velocity_ENU_m_s, Vec3(0.0, 2.0, 0.0))

    def test_of_joints_have_an_angle_for_each(self):
        c = _abi.struct_of(samples.JointStateSample)(7, 3, 2, 0, (0.5, -0.25, 0, 0))
        self.assertEqual(_abi.to_python(samples.JointStateSample, c).angles_rad, (0.5, -0.25))

    def test_seconds_become_whole_nanoseconds(self):
        self.assertEqual([_abi.to_ns(s) for s in (0.1, 1e-9, -1.5, 86400.000000001)],
                         [100_000_000, 1, -1_500_000_000, 86_400_000_000_001])
        for wrong in (math.nan, math.inf):
            with self.assertRaises((ValueError, OverflowError)):
                _abi.to_ns(wrong)


if __name__ == "__main__":
    unittest.main()
