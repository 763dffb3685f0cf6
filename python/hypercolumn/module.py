# SPDX-License-Identifier: Apache-2.0
"""Modules: programs with inputs, outputs and parameters."""

import atexit
import os
import sys
import threading
import weakref
from typing import Any, Callable, List, Optional, Sequence, TypeVar, Union

from hypercolumn import _hypercolumn
from hypercolumn._hypercolumn import Input, Kind, Messages, Output, Parameter, Timeout
from hypercolumn.errors import Error

Handler = TypeVar("Handler", bound=Callable[..., Any])
Value = TypeVar("Value", bool, int, float, str)


def _warn_of_unused(module: "weakref.ref[Module]") -> None:
    found = module()
    if found is not None and found._handled and not found._has_begun:
        found.log("its handlers were never called: end the program with module.run()")


class Together:
    """Synchronised inputs, returned by together()."""

    def __init__(self, inputs: Sequence[Input]) -> None:
        self.inputs: List[Input] = list(inputs)


def together(*inputs: Input) -> Together:
    """Synchronises two to eight inputs for Module.on(): one message of each, with equal times."""
    if len(inputs) < 2:
        raise Error("Invalid: together() takes two inputs or more", "Invalid")
    return Together(inputs)


class Module(_hypercolumn.Module):
    """A program with input ports, output ports and parameters, declared once.

    Its handlers run one after another on the thread that calls run(). It has all options of a
    module in C++, such as --help, --describe, --in and --out (doc/modules.md). A script needs
    neither handlers nor run(): `for message in input:` works while it waits for the next message.
    """

    def __init__(
        self,
        name: str,
        summary: str,
        *,
        background: bool = False,
        keep_running: bool = False,
        finish_when_stopped: bool = False,
    ) -> None:
        """`name` is in snake_case, as in the graph; `summary` is one sentence.

        In the `background`, the process yields the processor to closed loops: for a module that is
        in no hurry. With `keep_running` it runs until it is stopped, though its inputs have ended:
        for a device that sends unasked. With `finish_when_stopped` it first takes the messages that
        still come from modules that end beside it.
        """
        super().__init__(name, summary, background, keep_running, finish_when_stopped)
        self._handled: List[str] = []
        self._has_begun = False
        atexit.register(_warn_of_unused, weakref.ref(self))

    def input(
        self, name: str, kind: Kind, doc: str, *, actor: bool = False, keep: int = 0
    ) -> Input:
        """Declares an input.

        An `actor` moves something, so several writers need an arbiter. `keep` limits the queue to
        that number of the newest messages, so that a link in a graph does not block its writer
        unless the link has another `keep`.
        """
        port = self._input(name, kind, doc, actor, keep)
        port.module = self
        return port

    def output(
        self,
        name: str,
        kind: Kind,
        doc: str,
        *,
        on_demand: bool = False,
        keep: int = 0,
        columns: Sequence[str] = (),
    ) -> Output:
        """Declares an output, of one kind.

        One `on_demand` is sent only by a link to it alone, and has no part in the standard output
        that outputs share. With `keep`, sending never waits: for a slow reader so many of the
        newest messages wait, and without a reader a message is lost. `columns` are names of the
        numbers in a row, with their units: "age [s]".
        """
        return self._output(name, kind, doc, on_demand, keep, list(columns))

    def parameter(
        self,
        name: str,
        default: Value,
        unit: str,
        doc: str,
        *,
        min: Optional[float] = None,
        max: Optional[float] = None,
        step: int = 1,
        choices: Sequence[str] = (),
        positional: bool = False,
        fixed: bool = False,
    ) -> "Parameter[Value]":
        """Declares a parameter, of the type of its default; `value` is its current value.

        `unit` is "m", "rad", "px", "s", or "" for none. A number may have `min` and `max`, an
        integer also a `step`, a string `choices`. A `positional` one may be given without its name.
        A `fixed` one is only read at the start; changing it restarts the module.
        """
        return self._parameter(
            name, default, unit, doc, min, max, step, list(choices), positional, fixed
        )

    def on(self, inputs: Union[Input, Together]) -> Callable[[Handler], Handler]:
        """Calls a function with each message of an input, or with synchronised messages of several:

            @module.on(image)
            def look(message): ...

            @module.on(hc.together(left, right))
            def compare(left_message, right_message): ...

        An input has one handler.
        """
        ports = inputs.inputs if isinstance(inputs, Together) else [inputs]
        for port in ports:
            if port.name in self._handled:
                raise Error("Invalid: input %s has two handlers" % port.name, "Invalid")
            self._handled.append(port.name)

        def attach(handler: Handler) -> Handler:
            if isinstance(inputs, Together):
                self._on_together(ports, handler)
            else:
                self._on(inputs, handler)
            return handler

        return attach

    def every(self, period: "Union[float, Parameter[float]]") -> Callable[[Handler], Handler]:
        """Calls a function every `period` seconds, or at the rate of a parameter [Hz]; between
        messages, first one period after the start. Missed periods are skipped."""

        def attach(handler: Handler) -> Handler:
            self._every(period, handler)
            return handler

        return attach

    def after(self, seconds: float) -> Callable[[Callable[[], Any]], Timeout]:
        """Calls a function once, `seconds` after the start:

            @module.after(3)
            def silence():
                module.log("no packets for 3 s")

            silence.restart()

        After each restart() it is called again.
        """
        return lambda handler: self._after(seconds, handler)

    def generate(self, handler: Handler) -> Handler:
        """For a source: calls a function repeatedly while no message is queued, until stop()."""
        self._generate(handler)
        return handler

    def on_start(self, handler: Handler) -> Handler:
        """Calls a function once, when parameters are set and links are open."""
        self._on_start(handler)
        return handler

    def on_end(self, handler: Handler) -> Handler:
        """Calls a function once at the end: when all inputs have ended, after stop(), when no reader
        is left, or when the module is asked to stop; not after an error."""
        self._on_end(handler)
        return handler

    def run(self, arguments: Optional[Sequence[str]] = None) -> None:
        """Runs the module with the command line, or with `arguments` (no program name), until its
        inputs end, its outputs lose their readers, or it is asked to stop (Ctrl-C). An error is
        printed as one line on standard error, and ends the program with status 1 or 2.

        Output of handlers goes to standard error, since standard output belongs to the links.
        """
        self._has_begun = True
        words = sys.argv if arguments is None else [self.name, *arguments]
        outside, sys.stdout = sys.stdout, sys.stderr
        try:
            status = self._run(words)
        finally:
            sys.stdout = outside
        if status != 0:
            sys.exit(status)

    def _pull(self, port: Input) -> Messages:
        """The messages of an input that has no handler. The first call begins the module, which
        ends with the interpreter, so that a script can still send after its loop."""
        if port.name in self._handled:
            raise Error("Invalid: input %s has a handler" % port.name, "Invalid")
        if threading.current_thread() is not threading.main_thread():
            raise Error("Invalid: only the main thread can take messages in a loop", "Invalid")
        self._has_begun = True
        if not self._is_pulled:
            sys.stdout = sys.stderr
            atexit.register(self._end_script, os.getpid())
            self._begin(sys.argv[1:])
        return Messages(self, port)

    def _end_script(self, process: int) -> None:
        if os.getpid() != process:  # a fork of it
            return
        try:
            status = self._end(hasattr(sys, "last_value"))
        except SystemExit as error:  # of a handler
            status = error.code if isinstance(error.code, int) else int(error.code is not None)
        _hypercolumn.exit_with(status)
