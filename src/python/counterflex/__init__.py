"""Corrects machining programs for the errors and the elasticity of their machine.

Units of arrays are SI: m, rad, N, N m, N/m. Six-vectors have the translation first: ``(x y z rx ry rz)``,
``(fx fy fz mx my mz)``; their axes are those of the machine frame M. A pose is a homogeneous matrix (4, 4): the
tool tip in M. Columns of reports and names of parameters carry their units: ``before_dx_mm``, ``mount.x_mm``.

Bad input raises `InputError`, which has ``file``, ``line`` and ``column``; arrays of a wrong shape, or with numbers
that are not finite, raise `ValueError`. Numerical trouble raises nothing: it is a status, and the numbers are NaN.
A `Machine` never changes, and calls release the GIL: threads may share it.
"""

from __future__ import annotations

import difflib
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._errors import InputError

__all__ = [
    "Compensation", "Identification", "InputError", "Machine", "Report", "Solved", "Targets", "compensate", "identify", "predict", "verify",
]
__version__: str = _core.version

Path = Union[str, "os.PathLike[str]"]
Forces = Union[None, Path, Sequence[Path], ArrayLike]
Text = Union[str, bytes]
OptionValue = Union[None, bool, int, float, Path, Sequence[Path]]

_STATUSES = np.array(_core.statuses)
# What a run in memory does not have: files that are written, and files beside a program.
_OPTIONS = frozenset(_core.option_names) - {
    "machine", "forces", "output", "report", "plot", "proof", "force-overwrite", "max-points", "data",
}


class Solved(NamedTuple):
    """Where the tip is when poses are commanded. Rows of poses that are not ``converged`` are NaN."""

    status: NDArray[np.str_]
    """(n,) converged, not_converged, unreachable, singular, unstable or outside_travel"""
    deviation: NDArray[np.float64]
    """(n, 6) actual minus wanted: position (m), rotation vector (rad), axes of M"""
    pose: NDArray[np.float64]
    """(n, 4, 4) of the real tip (m)"""
    actuators: NDArray[np.float64]
    """(n, k) of the command, as the control shows them (m, rad; rotary ones but for full turns)"""


class Targets(NamedTuple):
    """What has to be commanded. Rows of poses that are not ``converged`` are NaN."""

    status: NDArray[np.str_]
    """(n,) as in `Solved`"""
    pose: NDArray[np.float64]
    """(n, 4, 4) to command (m)"""
    actuators: NDArray[np.float64]
    """(n, k) as in `Solved`"""


class Machine:
    """A machine of a machine file. It never changes; threads may share it."""

    def __init__(self, core: _core.Machine):
        self._core = core

    @classmethod
    def load(cls, path: Path) -> Machine:
        """The machine of a machine file.

        Raises `InputError` with line and column where the file is wrong, also if it cannot be read.
        """
        return cls(_core.load(os.fsencode(path)))

    @classmethod
    def from_text(cls, text: Text, name: Path = "machine.toml") -> Machine:
        """The machine of the text of a machine file; ``name`` is its path in messages."""
        return cls(_core.load_text(_bytes_of(text), os.fsencode(name)))

    @property
    def name(self) -> str:
        return self._core.name

    @property
    def path(self) -> str:
        """Of its file."""
        return self._core.path

    @property
    def controlled(self) -> tuple[str, ...]:
        """Components of the tip that a program controls: of x, y, z, rx, ry, rz."""
        return tuple(self._core.controlled)

    @property
    def actuators(self) -> tuple[str, ...]:
        """Names, in the order of actuator values."""
        return tuple(self._core.actuators)

    @property
    def home(self) -> NDArray[np.float64]:
        """(4, 4) pose of the nominal tip at home (m)."""
        return self._core.home

    @property
    def parameters(self) -> dict[str, float]:
        """What measurements can identify: values by name, in the unit that the name carries."""
        return self._core.parameters

    def with_parameters(self, changes: Mapping[str, float]) -> Machine:
        """The machine with other values of parameters, in the units of their names.

        Raises `ValueError` for an unknown name, a value that is not finite, and a compliance or mass that is not
        above 0; `InputError` where the changed machine has no valid home.
        """
        known = self.parameters
        values = {}
        for name, value in changes.items():
            if name not in known:
                near = difflib.get_close_matches(name, known, 1)
                hint = f"did you mean '{near[0]}'?" if near else "machine.parameters has the names"
                raise ValueError(f"unknown parameter '{name}'; {hint}")
            values[name] = float(value)
            if not np.isfinite(values[name]):
                raise ValueError(f"parameter {name} is {value}, must be finite")
        return Machine(self._core.with_parameters(values))

    def poses(self, positions: ArrayLike) -> NDArray[np.float64]:
        """(n, 4, 4) poses at positions (n, 3) of the tip (m, in M), in the orientation of home."""
        at = _array(positions, "positions", (3,))
        poses = np.repeat(self.home[None], len(at), axis=0)
        poses[:, :3, 3] = at
        return poses

    def solve(self, poses: ArrayLike, wrenches: ArrayLike | None = None, *, threads: int | None = None) -> Solved:
        """Where the tip of the real machine is when ``poses`` are commanded, as ``counterflex predict`` solves it.

        poses: (n, 4, 4) wanted poses of the tip in M (m). A machine that controls no orientation ignores theirs.
        wrenches: (n, 6), or (6,) for all poses, on the tool at its tip (N, N m; axes of M); none: no load
        threads: default: all processors. The result does not depend on it.

        Errors of assembly, weights, preloads and the part's fixture act. The tool is that of ``[tool]``. The direction
        of motion is not known, so joints with lost motion do not lag. Raises `ValueError` for a wrong shape, numbers
        that are not finite, and matrices that are not poses.
        """
        status, *arrays = self._core.solve(*self._arguments(poses, wrenches, threads))
        return Solved(_STATUSES[status], *arrays)

    def targets(self, poses: ArrayLike, wrenches: ArrayLike | None = None, *, threads: int | None = None) -> Targets:
        """What to command so that the tip of the loaded, imperfect machine has ``poses`` in its controlled components.

        Arguments and errors are those of `solve`. ``outside_travel``: an actuator would leave its range.
        """
        status, *arrays = self._core.targets(*self._arguments(poses, wrenches, threads))
        return Targets(_STATUSES[status], *arrays)

    def stiffness(
        self, poses: ArrayLike, wrenches: ArrayLike | None = None, *, threads: int | None = None
    ) -> NDArray[np.float64]:
        """(n, 6, 6) wrench at the tip per motion of the tip, actuators held (N/m, N, N m/rad; axes of M).

        Arguments and errors are those of `solve`; the stiffness is that of the loaded machine, without the fixture of
        the part. NaN where a pose is not solved, and where the machine is rigid in some direction: see `compliance`.
        """
        return self._core.tip_matrices(*self._arguments(poses, wrenches, threads, True))[1]

    def compliance(
        self, poses: ArrayLike, wrenches: ArrayLike | None = None, *, threads: int | None = None
    ) -> NDArray[np.float64]:
        """(n, 6, 6) motion of the tip per wrench at the tip, the inverse of `stiffness` (m/N, rad/(N m); axes of M).

        NaN where a pose is not solved.
        """
        return self._core.tip_matrices(*self._arguments(poses, wrenches, threads, False))[1]

    def __repr__(self) -> str:
        return f"<counterflex.Machine '{self.name}' of {self.path}>"

    def _arguments(self, poses: ArrayLike, wrenches: ArrayLike | None, threads: int | None, *more: bool) -> tuple[Any, ...]:
        at = _array(poses, "poses", (4, 4))
        R = at[:, :3, :3]
        is_pose = np.all(np.abs(R @ R.transpose(0, 2, 1) - np.eye(3)) < 1e-6, axis=(1, 2)) & (np.linalg.det(R) > 0)
        is_pose &= np.all(at[:, 3] == (0, 0, 0, 1), axis=1)
        if not is_pose.all():
            raise ValueError(f"poses[{np.argmin(is_pose)}] is not a pose: a rotation, a position, and the row 0 0 0 1")
        if wrenches is None:
            loads = np.zeros((len(at), 6))
        elif np.shape(wrenches) == (6,):
            loads = np.repeat(_array([wrenches], "wrenches", (6,)), len(at), axis=0)
        else:
            loads = _array(wrenches, "wrenches", (6,))
        if len(loads) != len(at):
            raise ValueError(f"there are {len(loads)} wrenches and {len(at)} poses; give as many, or one wrench (6,)")
        count = len(os.sched_getaffinity(0)) if threads is None else int(threads)
        if not 1 <= count <= 1024:
            raise ValueError(f"threads is {threads}, must be from 1 to 1024")
        return (at, loads, *more, count)


@dataclass(frozen=True, repr=False)
class Report:
    """What a run found."""

    data: dict[str, Any]
    """The document of ``--json``, "counterflex-report 1" (guide, "Reports")"""
    waypoints: NDArray[Any]
    """The columns of the CSV report, a structured array: ``pandas.DataFrame(report.waypoints)``. Unknown: NaN."""
    warnings: list[str]
    """What the command prints as warnings"""

    @property
    def verdict(self) -> str:
        """OK, PARTLY, NOTHING CORRECTED or FAILED; of predictions PREDICTED."""
        return self.data["verdict"]

    def __repr__(self) -> str:
        return f"<counterflex.Report {self.verdict}, {len(self.waypoints)} waypoints>"


class Compensation(NamedTuple):
    """The corrected program with its report."""

    text: Text | None
    """str or bytes, as the program was given; None where no program may be written: see the verdict"""
    report: Report


class Identification(NamedTuple):
    """A machine whose parameters fit measurements."""

    machine: Machine
    """With the identified values"""
    text: str | None
    """Of its machine file; None where ``with_parameters`` changed the machine before"""
    data: dict[str, Any]
    """The document "counterflex-identification 1" (guide, "Identify"): values, covariance, tests of the fit"""


def compensate(
    text: Text, machine: Machine, forces: Forces = None, *, name: Path = "program.ngc", causes: bool = True, **options: OptionValue
) -> Compensation:
    """Corrects a program, as ``counterflex compensate`` does, and verifies the corrected text.

    text: the program. Read it as bytes, or with ``newline=""``, so that its line ends stay.
    forces: a file of forces (.csv, .toml), several, or one wrench on all feed moves: (3,) or (6,), N and N m, axes of M
    name: of the program in messages; its ending is a hint for the dialect
    causes: whether waypoints have the causes of their deviation; a run takes about half the time without
    options: those of the command with ``_`` for ``-``: ``tolerance_mm=0.01``, ``work="machine"``, ``dialect="fanuc"``.
        None: the default. No file is written, so there is no ``output``. Environment and project files are not read.

    Raises `InputError` for wrong text, forces, options; `TypeError` for an option that does not exist.
    """
    given = _given(forces, options)
    result = _core.compensate(machine._core, _bytes_of(text), os.fsencode(name), given, bool(causes))
    corrected: Text | None = result[0]
    if corrected is not None and isinstance(text, str):
        corrected = result[0].decode("utf-8", "surrogateescape")
    return Compensation(corrected, _report(result))


def predict(
    text: Text, machine: Machine, forces: Forces = None, *, name: Path = "program.ngc", **options: OptionValue
) -> Report:
    """The deviation of a program without a correction, always with its causes. Arguments and errors are those of
    `compensate`, except ``causes``, which is of `compensate` alone."""
    return _report(_core.predict(machine._core, _bytes_of(text), os.fsencode(name), _given(forces, options)))


def verify(
    text: Text, corrected: Text, machine: Machine, forces: Forces = None, *, name: Path = "program.ngc", **options: OptionValue
) -> Report:
    """Solves a corrected program forward, against the path of its original ``text``, always with its causes. Other
    arguments and errors are those of `compensate`, except ``causes``, which is of `compensate` alone."""
    given = _given(forces, options)
    return _report(_core.verify(machine._core, _bytes_of(text), _bytes_of(corrected), os.fsencode(name), given))


def identify(
    machine: Machine, data: Path | Sequence[Path], *, fit: str | None = None, hold_out: str | None = None, keep_all: bool = False,
    prior: Path | None = None, threads: int | None = None
) -> Identification:
    """Finds the parameters that fit measurements best, as ``counterflex identify`` does.

    data: measurement files
    fit: sets of parameters that are tried, as "zeros,geometry"; default: as the command
    hold_out: "session", "region" or "20%": which rows test the fit
    keep_all: keep sets that do not improve held-out rows, as ``--all``
    prior: the JSON report of an earlier fit

    Raises `InputError` for wrong files and values, and for measurements that cannot determine a fit.
    """
    files = [os.fsencode(path) for path in ([data] if _is_path(data) else data)]
    given = _given(None, {} if threads is None else {"threads": threads})
    before = b"" if prior is None else os.fsencode(prior)
    found, text, document = _core.identify(machine._core, files, fit, hold_out, bool(keep_all), before, given)
    shown = None if text is None else text.decode("utf-8", "surrogateescape")
    return Identification(Machine(found), shown, json.loads(document))


def _array(values: ArrayLike, name: str, shape: tuple[int, ...]) -> NDArray[np.float64]:
    if np.iscomplexobj(values):
        raise ValueError(f"{name} has complex numbers, must be real")
    array = np.ascontiguousarray(values, dtype=np.float64)
    if array.shape[1:] != shape or array.ndim != 1 + len(shape):
        wanted = ", ".join(str(n) for n in ("n", *shape))
        raise ValueError(f"{name} has the shape {array.shape}, must be ({wanted})")
    if not np.isfinite(array).all():
        at = np.argwhere(~np.isfinite(array))[0]
        raise ValueError(f"{name}[{', '.join(map(str, at))}] is {array[tuple(at)]}, must be finite")
    return array


def _bytes_of(text: Text) -> bytes:
    if not isinstance(text, (str, bytes)):
        raise TypeError(f"a text is str or bytes, not {type(text).__name__}")
    return text.encode("utf-8", "surrogateescape") if isinstance(text, str) else text


def _is_path(value: Any) -> bool:
    return isinstance(value, (str, bytes, os.PathLike))


def _texts_of(value: Any) -> list[bytes]:
    if isinstance(value, (bool, np.bool_)):
        return [b"true" if value else b"false"]
    if isinstance(value, (int, float, np.number)):
        return [repr(value.item() if isinstance(value, np.number) else value).encode()]
    if _is_path(value):
        return [os.fsencode(value)]
    return [text for entry in value for text in _texts_of(entry)]


def _wrench_text(values: Any, name: str) -> bytes:
    wrench = np.asarray(values, dtype=np.float64)
    if wrench.shape not in ((3,), (6,)) or not np.isfinite(wrench).all():
        raise ValueError(f"{name} is {values!r}, must be paths of files, or a wrench of 3 or 6 finite numbers")
    return ",".join(repr(float(number)) for number in wrench).encode()


def _has_numbers(value: Any) -> bool:
    return not _is_path(value) and np.ndim(value) == 1 and np.asarray(value).dtype.kind in "iuf"


def _given(forces: Forces, options: Mapping[str, OptionValue]) -> list[tuple[str, list[bytes]]]:
    given: dict[str, list[bytes]] = {}
    for key, value in options.items():
        option = "-".join(key.split("_"))
        if option not in _OPTIONS:
            near = difflib.get_close_matches(option, _OPTIONS, 1)
            hint = "; did you mean '{}'?".format(near[0].replace("-", "_")) if near else ""
            raise TypeError(f"unknown option '{key}'{hint}")
        if value is None:
            continue
        is_wrench = option == "force" and _has_numbers(value)
        given.setdefault(option, []).extend([_wrench_text(value, key)] if is_wrench else _texts_of(value))
    if forces is not None:
        paths: list[Any] = [forces] if _is_path(forces) else list(forces)  # type: ignore[arg-type]
        if paths and all(_is_path(path) for path in paths):
            given.setdefault("forces", []).extend(os.fsencode(path) for path in paths)
        else:
            given.setdefault("force", []).append(_wrench_text(forces, "forces"))
    return list(given.items())


def _report(result: Any) -> Report:
    _, document, (names, table, statuses), warnings = result
    integers = {"index", "line", "iterations"}
    kinds = {"status": _STATUSES.dtype, "cutting": np.bool_, **{name: np.int64 for name in integers}}
    waypoints = np.empty(len(table), dtype=[(name, kinds.get(name, np.float64)) for name in names])
    for column, name in enumerate(names):
        waypoints[name] = statuses if name == "status" else table[:, column]
    return Report(json.loads(document), waypoints, warnings)
