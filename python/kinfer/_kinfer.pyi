# SPDX-License-Identifier: Apache-2.0
from os import PathLike
from typing import Any, Callable, Iterable, Mapping, Sequence, TypedDict

from numpy import bool_, float32, float64
from numpy.typing import ArrayLike, NDArray

__version__: str

_Path = str | PathLike[str]
_Progress = Callable[[str, float], object]

class InputError(ValueError): ...

class Robot:
    @staticmethod
    def load(path: _Path, *, base: str = ..., tip: str = ...) -> Robot: ...
    def forward(self, joints: ArrayLike, *, threads: int = ...) -> NDArray[float64]: ...
    def save(self, path: _Path) -> None: ...
    @property
    def name(self) -> str: ...
    @property
    def dof(self) -> int: ...
    @property
    def joint_names(self) -> list[str]: ...
    @property
    def limits(self) -> NDArray[float64]: ...
    @property
    def base(self) -> NDArray[float64]: ...
    @property
    def tool(self) -> NDArray[float64]: ...

class PoseSet:
    def __len__(self) -> int: ...
    @property
    def joints(self) -> NDArray[float64]: ...

class _Parameter(TypedDict):
    name: str
    nominal: float
    value: float
    sd: float
    unit: str
    identifiable: bool

class Calibration:
    @property
    def use(self) -> bool: ...
    @property
    def usability(self) -> str: ...
    @property
    def verdict(self) -> str: ...
    @property
    def parameters(self) -> list[_Parameter]: ...
    @property
    def covariance(self) -> NDArray[float64]: ...
    @property
    def robot(self) -> Robot: ...
    @property
    def rms_before(self) -> float: ...
    @property
    def rms_after(self) -> float: ...
    @property
    def evidence_json(self) -> str: ...
    @property
    def evidence(self) -> dict[str, Any]: ...
    def save(self, folder: _Path, *, offsets: str = ...) -> None: ...

class _Sensor(TypedDict):
    t: NDArray[float64]
    acc: NDArray[float32]
    gyr: NDArray[float32]
    mag: NDArray[float32] | None

class Recording:
    @property
    def sensors(self) -> dict[str, _Sensor]: ...
    @property
    def remarks(self) -> list[str]: ...

class Identification:
    @property
    def use(self) -> bool: ...
    @property
    def usability(self) -> str: ...
    @property
    def verdict(self) -> str: ...
    @property
    def joints(self) -> list[dict[str, Any]]: ...
    @property
    def robot(self) -> Robot: ...
    @property
    def evidence_json(self) -> str: ...
    @property
    def evidence(self) -> dict[str, Any]: ...
    def save(self, folder: _Path) -> None: ...

class _Alarm(TypedDict):
    kind: str
    sensor: str | None
    joint: str | None
    since: float
    until: float
    sentence: str
    turn: float | None  # [rad] of a sensor that was turned before the log began
    turn_sd: float | None
    turn_hidden_sd: float | None  # about the axis that the motion shows least

class TrackedRun:
    @property
    def use(self) -> bool: ...
    @property
    def usability(self) -> str: ...
    @property
    def verdict(self) -> str: ...
    @property
    def joint_names(self) -> list[str]: ...
    @property
    def time(self) -> NDArray[float64]: ...
    @property
    def q(self) -> NDArray[float64]: ...
    @property
    def qd(self) -> NDArray[float64]: ...
    @property
    def sd_q(self) -> NDArray[float64]: ...
    @property
    def sd_qd(self) -> NDArray[float64]: ...
    @property
    def tool(self) -> NDArray[float64]: ...
    @property
    def sd_tool(self) -> NDArray[float64]: ...
    @property
    def base(self) -> NDArray[float64]: ...
    @property
    def alarms(self) -> list[_Alarm]: ...
    @property
    def evidence_json(self) -> str: ...
    def save(self, folder: _Path) -> None: ...

class Tracker:
    def __init__(self, machine: Identification | _Path, *, start: ArrayLike | None = ..., base: str = ...) -> None: ...
    def add(self, t: float, acc: ArrayLike, gyr: ArrayLike) -> None: ...
    @property
    def sensors(self) -> list[str]: ...
    @property
    def joint_names(self) -> list[str]: ...
    @property
    def started(self) -> bool: ...
    @property
    def time(self) -> float: ...
    @property
    def q(self) -> NDArray[float64]: ...
    @property
    def qd(self) -> NDArray[float64]: ...
    @property
    def sd_q(self) -> NDArray[float64]: ...
    @property
    def tool(self) -> NDArray[float64]: ...
    @property
    def sd_tool(self) -> NDArray[float64]: ...
    @property
    def alarms(self) -> list[str]: ...

class _Plan(TypedDict):
    joints: NDArray[float64]
    expected_rms: float
    expected_worst: float
    random_rms: float
    rank: int
    parameters: int

class _Compensation(TypedDict):
    joints: NDArray[float64]
    residual: NDArray[float64]
    reached: NDArray[bool_]

_Log = Recording | _Path | Sequence[_Path] | Mapping[str, Any]

def read_log(paths: _Log) -> Recording: ...
def read_poses(path: _Path, robot: Robot, *, columns: str | None = ...) -> PoseSet: ...
def calibrate(
    robot: Robot,
    joints: ArrayLike | PoseSet | _Path,
    *,
    positions: ArrayLike | None = ...,
    poses: ArrayLike | None = ...,
    distances: ArrayLike | None = ...,
    anchors: ArrayLike | None = ...,
    sockets: Iterable[object] | None = ...,
    sd: ArrayLike | None = ...,
    sd_angle: float | None = ...,
    setup: Iterable[object] | None = ...,
    parameters: str | Sequence[str] = ...,
    model: str = ...,
    holdout: float | None = ...,
    earlier: Robot | None = ...,
    seed: int = ...,
    threads: int = ...,
    progress: _Progress | None = ...,
) -> Calibration: ...
def plan(
    robot: Robot,
    poses: int = ...,
    *,
    measured: str = ...,
    criterion: str = ...,
    sd: float | None = ...,
    sd_angle: float | None = ...,
    candidates: ArrayLike | None = ...,
    existing: PoseSet | None = ...,
    seed: int = ...,
    threads: int = ...,
) -> _Plan: ...
def compensate(
    corrected: Robot,
    nominal: Robot,
    joints: ArrayLike | None = ...,
    *,
    targets: ArrayLike | None = ...,
    frames: str = ...,
    seed: int = ...,
    threads: int = ...,
) -> _Compensation: ...
def identify(
    data: _Log,
    *,
    root: str | None = ...,
    sensors: Sequence[str] = ...,
    tree: Sequence[tuple[str, str]] = ...,
    update: Identification | _Path | None = ...,
    seed: int = ...,
    threads: int = ...,
    progress: _Progress | None = ...,
) -> Identification: ...
def orient(data: _Log, *, filter: str = ..., magnetometer: bool = ...) -> dict[str, NDArray[float64]]: ...
def track(
    machine: Identification | _Path,
    data: _Log,
    *,
    start: ArrayLike | None = ...,
    base: str = ...,
    smooth: bool = ...,
    progress: _Progress | None = ...,
) -> TrackedRun: ...
