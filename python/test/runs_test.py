"""Runs by a stand-in of `tether`; real ones fly in tests/system/packages/python."""

import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import textwrap
import time
import unittest
from unittest import mock

import tether

RESULT = {
    "scenario": "s", "condition": "host", "seed": 3, "outcome": "goal_missed", "exit_code": 1, "reason": "too late",
    "metrics": [{"name": "time_required", "kind": "time_required", "label": "Time required", "unit": "s", "value": 4.5,
                 "max": 3.0, "met": False},
                {"name": "oscillations", "kind": "oscillations", "label": "Oscillations", "unit": "1", "value": None}],
    "suts": [{"uav": "uav1"}], "pace": {"images": 3}, "this_run": {"doubts": [{"kind": "busy_machine"}]},
}  # fmt: skip


class Runs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def stand_in(self, body):
        """A program that does this in place of `tether`; `out` is its --out, `args` its arguments."""
        file = self.folder / "tether"
        file.write_text(f"#!{sys.executable}\n" + textwrap.dedent("""\
            import json, os, pathlib, sys
            args = sys.argv[1:]
            out = pathlib.Path(args[args.index("--out") + 1]) if "--out" in args else None
            """) + textwrap.dedent(body))
        file.chmod(0o755)
        patch = mock.patch.dict(os.environ, {"TETHER_PROGRAM": str(file)})
        patch.start()
        self.addCleanup(patch.stop)

    def leaving(self, code, more=""):
        self.stand_in(f"""\
            out.mkdir(exist_ok=True)
            (out / "result.json").write_text({json.dumps(json.dumps(RESULT))})
            (out / "sut-uav1.log").write_text("\\n".join(args))
            {more}
            print("it failed", file=sys.stderr)
            sys.exit({code})
            """)

    def test_a_result_has_what_result_json_has(self):
        self.leaving(1)
        result = tether.run("s.toml", out=self.folder / "out")
        self.assertEqual((result.outcome, result.reached_goal, result.seed, result.exit_code),
                         ("goal_missed", False, 3, 1))
        metric = result.metrics["time_required"]
        self.assertEqual((metric.value, metric.min, metric.max, metric.met), (4.5, None, 3.0, False))
        self.assertIsNone(result.metrics["oscillations"].value)
        self.assertEqual((result.pace, result.doubts), ({"images": 3}, [{"kind": "busy_machine"}]))

    def test_options_and_settings_become_arguments(self):
        self.leaving(0)
        settings = {"time_limit_s": 30, "uav.position_m": [1, 0, 1.2], "a": True, "b": "text"}
        result = tether.run("s.toml", condition="target, no sync", seed=0, target="t", settings=settings, images=True,
                            out=self.folder / "out")
        self.assertEqual(result.log().split("\n"), [
            "run", "s.toml", "--condition", "target, no sync", "--seed", "0", "--target", "t", "--images", "--out",
            str(self.folder / "out"), "--force", "--quiet", "--set", "time_limit_s=30", "--set",
            "uav.position_m=[1, 0, 1.2]", "--set", "a=true", "--set", "b=text"])

    def test_what_it_starts_finds_this_package(self):
        self.leaving(0, 'sys.path.insert(0, os.environ["PYTHONPATH"].split(":")[0]); import tether')
        with mock.patch.dict(os.environ, {"PYTHONPATH": "/mine"}):
            self.assertTrue(tether.run("s.toml", out=self.folder / "out"))

    def test_a_flight_that_failed_has_a_result(self):
        self.leaving(3)
        self.assertEqual(tether.run("s.toml", out=self.folder / "out").reason, "too late")

    def test_wrong_use_is_an_error_also_where_an_earlier_run_is(self):
        self.leaving(0)
        tether.run("s.toml", out=self.folder / "out")
        self.stand_in('print("tether: no such scenario", file=sys.stderr); sys.exit(2)')
        with self.assertRaisesRegex(tether.CommandError, "no such scenario") as raised:
            tether.run("s.toml", out=self.folder / "out")
        self.assertEqual(raised.exception.exit_code, 2)

    def test_a_missing_program_is_named(self):
        with mock.patch("tether.runs.near", return_value=None), mock.patch.dict(os.environ, {"PATH": "/none"}):
            with self.assertRaisesRegex(tether.CommandError, "Install Debian's package tether"):
                tether.run("s.toml")

    def test_the_answer_is_what_the_report_begins_with(self):
        self.leaving(0)
        result = tether.run("s.toml", out=self.folder / "out")
        self.stand_in("print('Fast enough: on host.\\n  → Advice\\nNot fast enough: on target.\\n\\nTable: no')")
        self.assertEqual(result.answer, "Fast enough: on host.\nNot fast enough: on target.")

    def test_a_campaign_has_its_results_as_columns(self):
        self.stand_in(f"""\
            for seed in (1, 2):
                at = out / "s" / "host" / f"seed-000{{seed}}"
                at.mkdir(parents=True)
                result = dict(json.loads({json.dumps(json.dumps(RESULT))}), seed=seed)
                (at / "result.json").write_text(json.dumps(result))
            (out / "campaign.json").write_text('{{"campaign": "c"}}')
            sys.exit(3)
            """)
        campaign = tether.campaign("c.toml", out=self.folder / "out")
        columns = campaign.columns()
        self.assertEqual(list(columns["seed"]), [1, 2])
        self.assertEqual(list(columns["time_required"]), [4.5, 4.5])
        self.assertEqual(list(columns["outcome"]), ["goal_missed"] * 2)

    def test_an_interrupt_ends_the_run_before_it_is_raised(self):
        ended = self.folder / "ended"
        self.stand_in(f"""\
            import signal, time
            signal.signal(signal.SIGINT, lambda *_: (pathlib.Path({str(ended)!r}).write_text("1"), sys.exit(3)))
            pathlib.Path({str(ended)!r} + ".begun").write_text("1")
            time.sleep(60)
            """)
        caller = subprocess.Popen([sys.executable, "-c", f"import tether; tether.run('s.toml', out={str(self.folder)!r})"], stderr=subprocess.PIPE,
                                  env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)})
        while not pathlib.Path(f"{ended}.begun").exists():
            time.sleep(0.01)
        caller.send_signal(signal.SIGINT)
        _, told = caller.communicate(timeout=30)
        self.assertIn(b"KeyboardInterrupt", told)
        self.assertTrue(ended.exists())


if __name__ == "__main__":
    unittest.main()
