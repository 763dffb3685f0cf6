# SPDX-License-Identifier: Apache-2.0
"""Attaches to running graphs on this host, or starts them."""

import contextlib
import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile
import time
from types import SimpleNamespace
from typing import Any, Callable, Dict, Iterator, List, Optional, Union

from hypercolumn import _hypercolumn
from hypercolumn._hypercolumn import Message, RunningGraph, Stream
from hypercolumn.errors import Error

_SILENCE = 5.0  # seconds without state until an error
_REPORT = 2.0  # seconds within which a module reports a new value
_STATE_LIMIT = 16 << 20  # bytes


def _text_of(value: Union[bool, int, float, str]) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


_TYPES: Dict[str, Callable[[str], Any]] = {
    "bool": lambda text: text == "true",
    "integer": int,
    "number": float,
    "string": str,
}


def _is_same(value: Any, other: Any) -> bool:
    both_nan = isinstance(value, float) and math.isnan(value) and math.isnan(float(other))
    return bool(both_nan or value == other)


class Parameters:
    """The parameters of a running graph by MODULE.PARAMETER, to read and set."""

    def __init__(self, graph: "Graph") -> None:
        self._graph = graph
        self._types: Dict[str, Dict[str, str]] = {}  # of parameters, by program

    def as_dict(self) -> Dict[str, Any]:
        """All current values, each of its declared type."""
        found = {}
        for module in self._graph.modules.values():
            for name, text in module.parameters.items():
                found["%s.%s" % (module.name, name)] = self._value(module, name, text)
        return found

    def _value(self, module: SimpleNamespace, name: str, text: str) -> Any:
        if module.program not in self._types:
            description = json.loads(self._graph.command("describe " + module.name)[0])
            self._types[module.program] = {
                each["name"]: each["type"] for each in description["parameters"]
            }
        return _TYPES[self._types[module.program].get(name, "string")](text)

    def __getitem__(self, name: str) -> Any:
        values = self.as_dict()
        if name not in values:
            raise KeyError(name)
        return values[name]

    def __setitem__(self, name: str, value: Union[bool, int, float, str]) -> None:
        """Sets a parameter, and waits until its module reports the new value. Errors: those of the
        command `set`; Closed if the module does not report it within 2 s."""
        text = _text_of(value)
        self._graph.command("set %s=%s" % (name, text))
        module, _, parameter = name.partition(".")
        wanted = self._value(self._graph.modules[module], parameter, text)
        end = time.monotonic() + _REPORT
        while not _is_same(wanted, self[name]):
            if time.monotonic() >= end:
                what = "%s=%s was sent, but not confirmed after %g s: " % (name, text, _REPORT)
                raise Error("Closed: " + what + "the module is stopped or busy", "Closed")
            time.sleep(0.02)

    def __iter__(self) -> Iterator[str]:
        return iter(self.as_dict())

    def __repr__(self) -> str:
        return repr(self.as_dict())


class Port:
    """An output of a running graph, graph["head_eyes.left"], observed without disturbing it.

    Each loop over it starts with new messages. A slow reader misses some; no module waits for it.
    """

    def __init__(self, graph: RunningGraph, name: str) -> None:
        self._graph, self.name = graph, name

    def __iter__(self) -> Iterator[Message]:
        return self._messages(math.inf)

    def _messages(self, end: float) -> Iterator[Message]:
        """Messages until the graph ends, or until a time of time.monotonic()."""
        try:
            with _hypercolumn.open_tap(self._graph, self.name) as stream:
                while True:
                    wait = None if end == math.inf else max(0.0, end - time.monotonic())
                    message = stream.take(wait)
                    if message is None:
                        return
                    yield message
        except StopIteration:
            return

    def read(self, seconds: float = math.inf) -> Message:
        """The next message. Error: Closed after `seconds` without one."""
        end = time.monotonic() + seconds
        for message in self._messages(end):
            return message
        if time.monotonic() >= end:
            raise Error("Closed: %s: no message in %g s" % (self.name, seconds), "Closed")
        raise Error("Closed: the graph has ended", "Closed")

    def __repr__(self) -> str:
        return "<Port %s of %r>" % (self.name, self._graph)


class Graph:
    """A running graph on this host: one `hc run`."""

    def __init__(self, running_graph: RunningGraph) -> None:
        self._running = running_graph
        self.name: str = running_graph.name
        self.process: int = running_graph.process

    def state(self) -> Dict[str, Any]:
        """The current state of the graph (spec/graph.md, G45)."""
        with Stream(self._running.state_uri, _STATE_LIMIT) as stream:
            end = time.monotonic() + _SILENCE
            while time.monotonic() < end:
                try:
                    message = stream.take(_SILENCE)
                except StopIteration:
                    raise Error("Closed: %r has ended" % self._running, "Closed") from None
                if message is not None and message.src == 1:
                    state: Dict[str, Any] = json.loads(message.text)
                    return state
        raise Error("Closed: %r does not answer; it may be stopped" % self._running, "Closed")

    @property
    def modules(self) -> Dict[str, SimpleNamespace]:
        """Its modules by name: `status`, `restarts`, `parameters` and so on."""
        return {each["name"]: SimpleNamespace(**each) for each in self.state()["modules"]}

    @property
    def links(self) -> List[SimpleNamespace]:
        """Its links: `source`, `target`, `per_second`, `age` and so on."""
        links = self.state()["links"]
        return [SimpleNamespace(source=each["from"], target=each["to"], **each) for each in links]

    @property
    def parameters(self) -> Parameters:
        """Its parameters: graph.parameters["blob.hue"] = 0.1."""
        return Parameters(self)

    def command(self, *rows: str) -> List[str]:
        """Executes commands of `hc graph`, one per row: all or none (spec/graph.md, G47)."""
        return _hypercolumn.ask(self._running, list(rows))

    def __getitem__(self, port: str) -> Port:
        """An output, MODULE.PORT."""
        return Port(self._running, port)

    def __repr__(self) -> str:
        return "<Graph %r>" % self._running


def running() -> List[Graph]:
    """The running graphs on this host."""
    return [Graph(each) for each in _hypercolumn.find_running()]


def attach(name: str = "") -> Graph:
    """The running graph NAME or NAME.PROCESS on this host; without a name, that of $HC_GRAPH, or
    the only one."""
    name = name or os.environ.get("HC_GRAPH", "")
    graphs = running()
    found = [each for each in graphs if name in ("", each.name, repr(each._running))]
    if len(found) == 1:
        return found[0]
    names = ", ".join(repr(each._running) for each in graphs)
    if found:
        raise Error("Invalid: several graphs are running; say which: " + names, "Invalid")
    wanted = 'no graph "%s" is running' % name if name else "no graph is running here"
    raise Error("NotFound: " + wanted + (": there is " + names if names else ""), "NotFound")


def _command() -> str:
    """The command hc installed with this package, else the one in PATH."""
    parents = pathlib.Path(__file__).parents
    for prefix in (parents[2], parents[4] if len(parents) > 4 else parents[2]):
        if os.access(prefix / "bin" / "hc", os.X_OK):
            return str(prefix / "bin" / "hc")
    found = shutil.which("hc")
    if found is None:
        raise Error("NotFound: no command hc; add its folder to PATH", "NotFound")
    return found


@contextlib.contextmanager
def start(file: "Union[str, os.PathLike[str]]", *options: str, wait: float = 60) -> Iterator[Graph]:
    """Runs a graph during a `with`, e.g. in a test:

        with hc.start("graphs/depth.toml", "--set", "depth.disparities=96") as graph:
            assert graph["depth.depth"].read().height == 600

    `options` are those of `hc run`. At entry each module runs or has ended. If the graph cannot
    run, raises an error with the output of `hc run`.
    """
    words = [_command(), "run", os.fspath(file), *options]
    with tempfile.TemporaryFile() as log:
        process = subprocess.Popen(
            words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=log
        )
        try:
            graph = _wait_for_graph(process, wait)
            if graph is None:
                log.seek(0)
                said = log.read().decode(errors="replace").strip()
                if process.poll() is None:
                    said = "not up after %g s: %s" % (wait, said)
                raise Error("Invalid: %s: %s" % (" ".join(words[1:3]), said), "Invalid")
            yield graph
        finally:
            if process.poll() is None:
                process.terminate()
            try:
                process.wait(15)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def _wait_for_graph(process: "subprocess.Popen[bytes]", wait: float) -> Optional[Graph]:
    end = time.monotonic() + wait
    while time.monotonic() < end and process.poll() is None:
        for graph in running():
            if graph.process == process.pid and _is_up(graph):
                return graph
        time.sleep(0.02)
    return None


def _is_up(graph: Graph) -> bool:
    try:
        states = [each.status for each in graph.modules.values()]
    except Error:  # the graph has ended
        return False
    return all(each in ("running", "ended") for each in states)
