# SPDX-License-Identifier: Apache-2.0
# What the extension holds, for type checkers.

from typing import (
    Any,
    Callable,
    Dict,
    Final,
    Generic,
    Iterator,
    List,
    Optional,
    Sequence,
    Tuple,
    TypeVar,
    Union,
)

import numpy

_Value = TypeVar("_Value", bool, int, float, str)
_Array = numpy.ndarray[Any, Any]
_Frame = Union[str, int]

class _Context:  # what a with ends
    def __exit__(self, *error: object) -> None: ...

class Message:
    matrix: Final[_Array]
    numbers: Final[Tuple[Any, ...]]
    text: Final[str]
    src: Final[int]
    dst: Final[int]
    seq: Final[int]
    ttl: Final[int]
    time: Final[int]
    mode: Final[int]
    coord: Final[int]
    width: Final[int]
    height: Final[int]
    components: Final[int]
    type: Final[str]
    scalar: Final[str]
    encoding: Final[str]
    def copy(self) -> Message: ...
    def _repr_png_(self) -> Optional[bytes]: ...

class Kind:
    def of(self, height: int, width: int) -> Kind: ...
    def in_(self, coord: Union[int, str]) -> Kind: ...
    def finite(self) -> Kind: ...

def kind(type: str, components: int, scalar: Any) -> Kind: ...
def any_of(*kinds: Kind) -> Kind: ...
def coords() -> Dict[str, int]: ...

class Input:
    name: Final[str]
    module: Any
    def __iter__(self) -> Iterator[Message]: ...

class Messages:
    def __init__(self, module: Module, input: Input) -> None: ...
    def __iter__(self) -> Iterator[Message]: ...
    def __next__(self) -> Message: ...

class Loan(_Context):
    def __enter__(self) -> _Array: ...

class Output:
    name: Final[str]
    linked: Final[bool]
    def send(
        self,
        message: Any,
        *,
        time: int = ...,
        dst: int = ...,
        mode: int = ...,
        coord: Union[int, str] = ...,
    ) -> None: ...
    def loan(
        self,
        height: Optional[int] = None,
        width: Optional[int] = None,
        *,
        time: int = ...,
        dst: int = ...,
        mode: int = ...,
        coord: Union[int, str] = ...,
    ) -> Loan: ...

class Parameter(Generic[_Value]):
    @property
    def value(self) -> _Value: ...
    name: Final[str]

class Timeout:
    def restart(self, seconds: Optional[float] = None) -> None: ...
    def stop(self) -> None: ...

class ModuleFrames:
    def __init__(self, module: Module) -> None: ...
    def lookup(self, target: _Frame, source: _Frame, time: int) -> _Array: ...
    def nearest(self, target: _Frame, source: _Frame, time: int) -> _Array: ...
    def when_known(
        self, target: _Frame, source: _Frame, time: int, handler: Callable[[Optional[_Array]], Any]
    ) -> None: ...

class Module:
    def __init__(
        self,
        name: str,
        summary: str,
        background: bool,
        keep_running: bool,
        finish_when_stopped: bool,
    ) -> None: ...
    def _input(self, name: str, kind: Kind, doc: str, actor: bool, keep: int) -> Input: ...
    def _output(
        self,
        name: str,
        kind: Kind,
        doc: str,
        on_demand: bool,
        keep: int,
        columns: Sequence[str],
    ) -> Output: ...
    def _parameter(
        self,
        name: str,
        default: _Value,
        unit: str,
        doc: str,
        min: Optional[float],
        max: Optional[float],
        step: int,
        choices: List[str],
        positional: bool,
        fixed: bool,
    ) -> Parameter[_Value]: ...
    def _on(self, input: Input, handler: Callable[..., Any]) -> None: ...
    def _on_together(self, inputs: List[Input], handler: Callable[..., Any]) -> None: ...
    def _every(
        self, period: Union[float, Parameter[float]], handler: Callable[..., Any]
    ) -> None: ...
    def _after(self, seconds: float, handler: Callable[[], Any]) -> Timeout: ...
    def _generate(self, handler: Callable[..., Any]) -> None: ...
    def _on_start(self, handler: Callable[..., Any]) -> None: ...
    def _on_end(self, handler: Callable[..., Any]) -> None: ...
    def _run(self, words: Sequence[str]) -> int: ...
    def _begin(self, words: Sequence[str]) -> None: ...
    def _end(self, has_failed: bool) -> int: ...
    _is_pulled: Final[bool]
    def keep_rate(self, rate: float) -> None: ...
    def stop(self) -> None: ...
    def log(self, line: str, level: str = "info") -> None: ...
    def log_once(self, kind: str, line: str) -> None: ...
    def now(self) -> int: ...
    focus: Final[int]
    has_focus: Final[bool]
    name: Final[str]
    instance: Final[str]

class Stream(_Context):
    def __init__(self, uri: str, limit: Optional[int] = None) -> None: ...
    def __iter__(self) -> Iterator[Message]: ...
    def __next__(self) -> Message: ...
    def take(self, seconds: Optional[float] = None) -> Optional[Message]: ...
    def close(self) -> None: ...
    def __enter__(self) -> Stream: ...

class RunningGraph:
    name: Final[str]
    process: Final[int]
    state_uri: Final[str]

def exit_with(status: int) -> None: ...
def find_running() -> List[RunningGraph]: ...
def ask(graph: RunningGraph, commands: List[str]) -> List[str]: ...
def open_tap(graph: RunningGraph, port: str) -> Stream: ...
