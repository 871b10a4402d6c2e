"""The package as a whole: it is documented, light to import, and says what is missing."""

import inspect
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import tether
from tether import _abi, errors


def run_python(code):
    return subprocess.run([sys.executable, "-B", "-c", code], capture_output=True, text=True)


class Package(unittest.TestCase):
    def test_all_that_is_public_is_documented(self):
        for name in tether.__all__:
            thing = getattr(tether, name)
            self.assertTrue(inspect.getdoc(thing), name)
            if inspect.isclass(thing) and thing.__module__.startswith("tether"):
                self.assertNotEqual(thing.__doc__, getattr(thing.__base__, "__doc__", None), name)
                for member, value in vars(thing).items():
                    if not member.startswith("_") and callable(getattr(value, "fget", value)):
                        self.assertTrue(inspect.getdoc(value), f"{name}.{member}")

    def test_it_imports_no_package_that_not_every_program_needs(self):
        code = "import sys, tether; print({'numpy', 'pandas', 'zstandard', 'matplotlib'} & {*sys.modules})"
        self.assertEqual(run_python(code).stdout, "set()\n")

    def test_a_missing_package_is_named(self):
        with mock.patch.dict(sys.modules, {"numpy": None}):
            with self.assertRaisesRegex(ImportError, "pixels need the module numpy: install Debian's python3-numpy"):
                errors.need("numpy", "python3-numpy", "pixels")

    def test_the_newest_build_of_a_checkout_is_taken_or_what_is_in_the_prefix(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder).resolve()
            for age, file in enumerate(("build/ci/lib/l.so", "build/dev/lib/l.so", "build/asan/lib/l.so", "lib/m/p.so")):
                (root / file).parent.mkdir(parents=True)
                (root / file).touch()
                os.utime(root / file, (1e9 + age, 1e9 + age))
            for package in ("python/tether", "lib/python3/dist-packages/tether"):
                with mock.patch("tether._abi.__file__", str(root / package / "_abi.py")):
                    self.assertEqual(_abi.near("l.so", "lib"), str(root / "build/dev/lib/l.so"))
                    self.assertEqual(_abi.near("p.so", "lib", "lib/*"), str(root / "lib/m/p.so"))
                    self.assertIsNone(_abi.near("q.so", "lib"))

    def test_a_missing_library_is_named(self):
        with mock.patch.dict("os.environ", {"TETHER_CLIENT_LIBRARY": "/no/such.so"}):
            told = run_python("import tether; tether.connect()").stderr
        self.assertIn("/no/such.so", told)
        self.assertIn("Install Debian's libtether-client1", told)

    def test_without_a_run_connecting_fails_with_the_message_of_the_library(self):
        with self.assertRaisesRegex(tether.InvalidError, "TETHER_ADDRESS|address") as raised:
            tether.connect(preload=False)
        self.assertEqual(raised.exception.code, tether.Code.INVALID)
        with self.assertRaises(ConnectionError):
            tether.connect(address="127.0.0.1:1", token="0" * 32, timeouts_s=(0.2, 0.2))


if __name__ == "__main__":
    unittest.main()
