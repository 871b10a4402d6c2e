"""Runs and campaigns by the program `tether`, and what they leave."""

import functools
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from ._abi import near
from .errors import CommandError
from .record import Record, _array

if TYPE_CHECKING:
    from numpy.typing import NDArray

Path = str | os.PathLike[str]


def program() -> str:
    """Path of `tether`: what TETHER_PROGRAM names, else the one near this package, else that of the PATH."""
    found = os.environ.get("TETHER_PROGRAM") or near("tether", "bin") or shutil.which("tether")
    if not found:
        raise CommandError("the program tether was not found. Install Debian's package tether, build the target "
                           "tether, or set TETHER_PROGRAM to its path", 2)
    return found


def _tether(*arguments: str, allowed: tuple[int, ...] = (0,)) -> str:
    """Runs a command and returns its standard output. Programs that it starts find this package."""
    package = str(pathlib.Path(__file__).resolve().parents[1])
    paths = [package, *filter(None, [os.environ.get("PYTHONPATH")])]
    # Without a fixed seed of hashes, what an interpreter computes differs from start to start.
    environment = {"PYTHONHASHSEED": "0", **os.environ, "PYTHONPATH": os.pathsep.join(paths), "COLUMNS": "100000",
                   "NO_COLOR": "1"}
    with subprocess.Popen([program(), *arguments], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, errors="replace", env=environment) as process:
        try:
            out, err = process.communicate()
        except BaseException:
            process.send_signal(signal.SIGINT)  # it ends what it has started
            process.wait()
            raise
    if process.returncode not in allowed:
        raise CommandError(err.strip() or f"tether {arguments[0]} ended with {process.returncode}", process.returncode)
    return out


def _settings(settings: Mapping[str, Any] | None) -> list[str]:
    """Options --set. Values of Python are written as TOML has them; texts stay as they are."""
    values = {key: value if isinstance(value, str) else json.dumps(value) for key, value in (settings or {}).items()}
    return [option for key, value in values.items() for option in ("--set", f"{key}={value}")]


def _options(**options: Any) -> list[str]:
    """Options of a command; those that are None or False are left out."""
    return [word for name, value in options.items() if value is not None and value is not False
            for word in ([f"--{name}"] if value is True else [f"--{name}", str(value)])]


@dataclass(frozen=True)
class Metric:
    """A metric of a run. `value` is None if it could not be computed, `met` if there is no limit."""

    name: str
    label: str
    unit: str
    value: float | None
    min: float | None
    max: float | None
    met: bool | None


class Result:
    """What a run left in its folder. `data` is all of result.json; properties have what is asked for most."""

    def __init__(self, folder: Path) -> None:
        """Of a run's folder; raises OSError if it has no result.json."""
        self.folder = pathlib.Path(folder)
        self.data: dict[str, Any] = json.loads((self.folder / "result.json").read_text())
        self.scenario: str = self.data["scenario"]
        self.condition: str = self.data["condition"]
        self.seed: int = self.data["seed"]
        #: "goal_reached", "goal_missed" or "failed"
        self.outcome: str = self.data["outcome"]
        #: One line for a person: why it ended so.
        self.reason: str = self.data["reason"]
        #: 0: reached; 1: missed; 2: wrong use; 3: failed, or no verdict holds.
        self.exit_code: int = self.data["exit_code"]
        #: Computing times by stage, and how often the camera was read; None if nothing was read.
        self.pace: dict[str, Any] | None = self.data.get("pace")
        #: What can have moved the result, such as a busy machine: each has a `kind`, a `subject` and an `amount`.
        self.doubts: list[dict[str, Any]] = self.data.get("this_run", {}).get("doubts", [])
        self.metrics: dict[str, Metric] = {
            metric["name"]: Metric(metric["name"], metric["label"], metric["unit"],
                                   *(metric.get(key) for key in ("value", "min", "max", "met")))
            for metric in self.data["metrics"]}

    def __repr__(self) -> str:
        return f"<tether.Result {self.scenario}, {self.condition}, seed {self.seed}: {self.outcome}>"

    @property
    def reached_goal(self) -> bool:
        """Whether every program reached its goal within the limits."""
        return self.outcome == "goal_reached"

    @functools.cached_property
    def answer(self) -> str:
        """Whether the computer is fast enough, and why: the first lines of `tether report`."""
        return _answer(self.folder)

    @functools.cached_property
    def record(self) -> Record:
        """The record of the run."""
        return Record(self.folder / "record.mcap")

    def log(self, uav: str | None = None) -> str:
        """What the program of a UAV (the first one by default) has printed."""
        return (self.folder / f"sut-{uav or self.data['suts'][0]['uav']}.log").read_text(errors="replace")


class Campaign:
    """What a campaign left in its folder."""

    def __init__(self, folder: Path) -> None:
        """Of a campaign's folder; raises OSError if it has no campaign.json."""
        self.folder = pathlib.Path(folder)
        self.data: dict[str, Any] = json.loads((self.folder / "campaign.json").read_text())
        self.results = [Result(file.parent) for file in sorted(self.folder.glob("*/*/seed-*/result.json"))]

    @functools.cached_property
    def answer(self) -> str:
        """Whether each computer is fast enough, and why: the first lines of `tether report`."""
        return _answer(self.folder)

    def columns(self) -> "dict[str, NDArray[Any]]":
        """A row for each flight: scenario, condition, seed, outcome, and each metric (NaN if it has none)."""
        names = dict.fromkeys(name for result in self.results for name in result.metrics)
        columns = {name: [getattr(result, name) for result in self.results]
                   for name in ("scenario", "condition", "seed", "outcome")}
        for name in names:
            metrics = [result.metrics.get(name) for result in self.results]
            columns[name] = [float("nan") if metric is None or metric.value is None else metric.value
                             for metric in metrics]
        return {name: _array(values) for name, values in columns.items()}


def _answer(folder: pathlib.Path) -> str:
    answer, _, _ = _tether("report", str(folder)).partition("\n\n")
    return "\n".join(line for line in answer.splitlines() if not line.startswith("  "))


def run(scenario: Path, *, condition: str | None = None, seed: int | None = None, target: str | None = None,
        profile: str | None = None, simulator: str | None = None, settings: Mapping[str, Any] | None = None,
        images: bool = False, out: Path | None = None) -> Result:
    """Flies a scenario: a file, or the name of a shipped one. Options are those of `tether run`.

    `settings` replaces values of the scenario: {"time_limit_s": 30, "uav.position_m": [1, 0, 1]}. An earlier run in
    the folder `out` is replaced; by default, the run has a new folder below that of temporary files, which stays.
    Raises CommandError if nothing was flown. A flight that failed has a result with its reason.
    """
    folder = _folder(out)
    options = _options(condition=condition, seed=seed, target=target, profile=profile, simulator=simulator,
                       images=images, out=folder, force=True, quiet=True)
    before = _written(folder / "result.json")
    try:
        _tether("run", str(scenario), *options, *_settings(settings), allowed=(0, 1))
    except CommandError:
        if _written(folder / "result.json") in (None, before):
            if out is None:
                shutil.rmtree(folder)
            raise
    return Result(folder)


def _folder(out: Path | None) -> pathlib.Path:
    """The folder of a run or campaign."""
    return pathlib.Path(tempfile.mkdtemp(prefix="tether-") if out is None else out)


def _written(file: pathlib.Path) -> tuple[int, int] | None:
    """What differs when a file was written again."""
    return (file.stat().st_ino, file.stat().st_mtime_ns) if file.exists() else None


def campaign(file: Path, *, out: Path | None = None, resume: bool = False, simulator: str | None = None) -> Campaign:
    """Flies a campaign: a file, or the name of a shipped one. Options are those of `tether campaign`.

    `resume` continues an earlier one in the folder `out`; by default, it has a new folder below that of temporary
    files, which stays. Flights that fail are among the results. Raises CommandError if nothing was flown.
    """
    folder = _folder(out)
    _tether("campaign", str(file), *_options(out=folder, resume=resume, simulator=simulator), allowed=(0, 3))
    return Campaign(folder)
