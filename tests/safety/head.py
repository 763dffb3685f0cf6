# SPDX-License-Identifier: Apache-2.0
"""The whole simulated head while it runs: its modules, the seat of its page, its neck.

    hung_test.py BUILD_FOLDER [TEST …], and so the others; HC_FULL=1: as long as the table says
"""

import contextlib
import os
import pathlib
import re
import signal
import sys
import time

ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests/pipes"))

from driver import PageSocket, Seat, seat_bid, seat_stick  # noqa: E402
from feeder import Feeder, Source  # noqa: E402
from harness import wait_until  # noqa: E402
from page import Page  # noqa: E402
from streams import Focus, Line, Motion, Stream, run_delay, rotation  # noqa: E402
from web_socket import get  # noqa: E402

IS_FULL = os.environ.get("HC_FULL") == "1"
HEAD = ROOT / "graphs/head.toml"
SETTINGS = {"head_tracker.listen": "127.0.0.1:0", "web.port": 0, "head_eyes.ball": "roll"}
# Few and small images, which take little time, where these are no matter, and what they are to whom
# they matter; with them it cannot be calibrated.
SMALL = {
    "head_eyes.rate": 10,
    "head_eyes.width": 160,
    "head_eyes.height": 120,
    "head_eyes.focal": 120,
    "rectify.focal": 120,
    "calibrate.salience": 0,
    "left_ball.min_area": 3,
    "right_ball.min_area": 3,
    **{
        "%s.%s" % (name, parameter): value
        for name in ("track", "read_gaze")
        for parameter, value in (("focal", 120), ("cx", 79.5), ("cy", 59.5))
    },
}
PATIENCE = 40  # with which a test waits for what must come [s]
MOST_PAN = 0.5  # how far a person turns the head here [rad]


def new_name():
    """For a socket of the test: of the abstract namespace, of nobody else."""
    new_name.count = getattr(new_name, "count", 0) + 1
    return "safety.%d.%d" % (os.getpid(), new_name.count)


class Head(Page):
    """One run of graphs/head.toml, and what is connected to it."""

    def begin(self, prefix="", options="", by_arrival=False, is_calibrated=True, **settings):
        """Runs the head until it is calibrated, and observes its neck. `prefix`: what starts it,
        with FOLDER for that of the test; `by_arrival`: as Stream has it."""
        self.setUp()
        self.sources, self.added, self.seat, self.page = {}, [], None, None
        self.cookie = ""
        sets = {**SETTINGS, "calibrate.calibration_file": self.path("calibration.yml"), **settings}
        words = " ".join("--set %s=%s" % each for each in sets.items())
        self.by_arrival = by_arrival
        prefix = prefix.replace("FOLDER", self.folder.name)
        os.mkdir(self.path("disk"))
        command = "exec %s hc run %s %s %s >out 2>said" % (prefix, HEAD, words, options)
        begun = time.monotonic()
        self.process = self.start(command, stdout=-3, stderr=-3)
        wait_until(lambda: self.process.poll() is not None or self.is_whole() and self.has_page())
        assert self.process.poll() is None, self.said()
        self.start_took = time.monotonic() - begun  # a measure of this machine [s]
        self.motion = self.stream(Motion, "head_unit.motion", "1024")
        self.line = self.stream(Line, "head_unit.received", "4096")
        self.focused = self.stream(Focus, "workspace.focus", "4096")
        self.guard = self.stream(Stream, "web.stop", "64")
        wait_until(lambda: self.motion.messages)
        if is_calibrated:
            wait_until(lambda: "calibrate: cameras" in self.said())

    def said(self):
        return self.read("said")

    def wait(self, condition, what):
        """Waits for an event; where it does not come, says how the head is instead."""
        end = time.monotonic() + PATIENCE
        while not (result := condition()):
            if time.monotonic() > end:
                state = self.state_now()
                idle = ["%(name)s %(status)s %(detail)s" % m for m in state["modules"]]
                idle = [each for each in idle if not each.endswith(" running ")]
                self.fail(
                    "not within %d s: %s; focus %s; pan %.3f; %s; it said %s"
                    % (PATIENCE, what, state["focus"], self.motion.pan(), idle, self.said()[-1500:])
                )
            time.sleep(0.01)
        return result

    # What runs.

    def state_now(self):
        messages = self.observe(self.process, "head")
        with contextlib.closing(messages):
            return self.state(messages)

    def is_whole(self):
        try:
            return self.all_run(self.state_now())
        except OSError:  # it is starting
            return False

    def is_going_on(self):
        """Whether the workspace decides, and the unit says where it is."""
        counts = len(self.focused.messages), len(self.motion.messages)
        self.motion.wait_more(20)
        return len(self.focused.messages) > counts[0]

    def names(self):
        return [each["name"] for each in self.state_now()["modules"]]

    def pid(self, name):
        return wait_until(lambda: self.module(self.state_now(), name)["pid"])

    def restarts(self, but=()):
        """How often modules have been restarted, by name."""
        modules = self.state_now()["modules"]
        return {each["name"]: each["restarts"] for each in modules if each["name"] not in but}

    def tell(self, *commands):
        """Commands of the graph, which are done."""
        answer = self.ask(self.process, *commands, name="head")
        assert answer == ["ok"], (commands, answer)

    def send_signal(self, name, number):
        pid = self.pid(name)
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, number)
        return pid

    @contextlib.contextmanager
    def hung(self, name):
        """A module that hangs, also when it is started anew; gives when it began [ns]."""
        pids = []

        def hang(_):
            pid = self.module(self.state_now(), name)["pid"]
            if pid and pid not in pids:
                pids.append(self.send_signal(name, signal.SIGSTOP))

        hang(0)
        moment, feeder = time.time_ns(), Feeder(hang, 0.2)
        try:
            yield moment
        finally:
            feeder.end()
            for pid in pids:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGCONT)

    def sent(self):
        """How many messages each output has sent, over its links."""
        counts = {}
        for link in self.state_now()["links"]:
            counts[link["from"]] = max(counts.get(link["from"], 0), link["messages"])
        return counts

    def needs(self):
        """By module: all that it cannot work without, and itself. Where several write to an input,
        any one is enough."""
        writers = {}
        for link in self.state_now()["links"]:
            writers.setdefault(link["to"], set()).add(link["from"].split(".")[0])
        only = {}
        for end, names in writers.items():
            if len(names) == 1:
                only.setdefault(end.split(".")[0], set()).update(names)

        def all_before(name):
            found, left = set(), [name]
            while left:
                each = left.pop()
                if each not in found:
                    found.add(each)
                    left += only.get(each, ())
            return found

        return {name: all_before(name) for name in self.names()}

    # What it is connected to.

    def stream(self, kind, output, keep):
        name = new_name()
        self.tell("link %s unix-listen:@%s keep=%s" % (output, name, keep))
        stream = kind("\0" + name, self.by_arrival)
        self.addCleanup(stream.end)
        return stream

    def source(self, port, number=0):
        """A source of an input, over a link of its own."""
        key = port, number
        if key not in self.sources:
            name = new_name()
            self.tell("link unix-listen:@%s %s" % (name, port))
            self.sources[key] = Source("\0" + name)
            self.added.append("unlink unix-listen:@%s %s" % (name, port))
        return self.sources[key]

    def unlink_sources(self):
        for source in self.sources.values():
            source.end()
        while self.added:
            self.tell(self.added.pop())
        self.sources = {}

    # A person.

    def has_page(self):
        return "web: page: " in self.said()

    def log_in(self):
        """The cookie of the session: the one that it has, or one by the token printed last."""

        def tries():
            found = re.findall(r"http\S*:(\d+)/\?token=(\w+)", self.said())
            try:
                self.port, self.token = int(found[-1][0]), found[-1][1]
                if self.cookie and get(self.port, "/", Cookie=self.cookie)[0] == 200:
                    return self.cookie
                return self.session()
            except (OSError, AssertionError, IndexError):  # it is being started anew
                return None

        return wait_until(tries)

    def open_page(self):
        self.close_page()
        self.cookie = self.log_in()
        self.page = PageSocket(self.port, self.cookie)
        wait_until(lambda: self.page.session)

    def close_page(self):
        self.leave()
        if self.page:
            self.page.end()
        self.page = None

    def sit(self, says):
        """Takes the seat, and says what is to be said from now on."""
        self.leave()
        self.seat = Seat(self.port, self.cookie, says)

    def leave(self):
        if self.seat:
            self.seat.leave()
        self.seat = None

    def mode(self, name):
        return self.state_now()["modes"][name]

    def focus(self):
        found = self.state_now()["focus"]["workspace"]
        return found and found["mode"]

    def to_and_fro(self):
        """Which way the stick is to be pushed, now, so that the head moves all the time: 1 or -1."""
        way = 1

        def now():
            nonlocal way
            if abs(self.motion.pan()) > MOST_PAN:
                way = -1 if self.motion.pan() > 0 else 1
            return way

        return now

    def pushing(self):
        """What one says who pushes the stick in the page to and fro."""
        mode, way = self.mode("point"), self.to_and_fro()
        return lambda _: (seat_bid(1, mode), seat_stick(way()))

    def drive(self):
        """Pushes the stick in the page, until that moves the head, and not a task of its own."""
        self.sit(self.pushing())
        self.wait_focus("point")
        self.wait_moving()

    def turning(self):
        """The same with the own head."""
        mode = self.mode("telepresence")

        def says(now):
            pan = MOST_PAN * (2 * abs(now % 2 - 1) - 1)
            return seat_bid(1, mode), rotation(pan, src=2)

        return says

    def press_stop(self):
        """Presses stop in the page; when that was [ns]."""
        moment = time.time_ns()
        self.page.order("estop")
        return moment

    def wait_guarded(self):
        """Waits until the workspace knows of the page: from then on its silence halts the head."""
        begin = time.time_ns()

        def words():  # which the workspace gets at the same time, and two are enough for it
            return [at for at, word in list(self.guard.messages) if at >= begin and int(word) == 0]

        self.wait(lambda: len(words()) > 3, "the page guards the robot")
        self.focused.wait_until(words()[3])

    def clear_stop(self):
        if self.page is None:
            self.open_page()
        self.wait(lambda: self.page.ask("estop clear") == "ok", "the stop is cleared")
        self.wait(lambda: self.page.session.get("stopped") is False, "the page says so")

    # How it moves.

    def chain(self):
        """The processes that a command passes through."""
        modules = {each["name"]: each["pid"] for each in self.state_now()["modules"]}
        return [modules[name] for name in ("web", "workspace", "point", "head_neck", "head_unit")]

    def wait_focus(self, name):
        mode = self.mode(name)
        self.wait(lambda: self.focused.mode() == mode, name + " has the focus")

    def wait_moving(self):
        """Waits until it has been moving for a while."""
        seconds = 0.3

        def moves():
            now = time.time_ns()
            times = self.motion.moves(self.motion.since(now - int(seconds * 1e9)))
            return times and times[-1] - times[0] > 0.8 * seconds * 1e9

        self.wait(moves, "the head moves")

    @contextlib.contextmanager
    def waits(self):
        waits = Waits([os.getpid(), *self.chain()])  # this process presses, and takes the time
        try:
            yield waits
        finally:
            waits.feeder.end()

    def restart_waited(self, name, before):
        """The waits for a processor of a restarted module and, beyond `before` [ns], of the runner
        [s]."""
        return (run_delay(self.process.pid) - before + run_delay(self.pid(name))) / 1e9

    def quiet(self):
        """Has no task bid of its own, until settle()."""
        self.tell(
            *("set %s.%s=0" % each for each in (("track", "salience"), ("read_gaze", "salience"))),
            "set read_gaze.idle_salience=0",
        )
        self.wait(lambda: self.focus() is None, "no task has the focus")
        self.motion.rests_at(time.time_ns())

    def settle(self):
        """As it was at first: all run, nobody drives, nothing is stopped."""
        self.close_page()
        self.wait(self.is_whole, "all run")
        self.unlink_sources()
        self.tell(
            "set track.salience=0.6",
            "set read_gaze.salience=0.4",
            "set read_gaze.idle_salience=0.1",
        )
        self.open_page()
        self.wait(lambda: self.page.session["stopped"] is not None, "the workspace is heard")
        if self.page.session["stopped"]:
            self.clear_stop()
        self.wait_guarded()


class Waits:
    """For how long the processes that a command passes through wait for a processor, all together:
    so much of what is measured says how busy the machine is, and is not the head's."""

    def __init__(self, processes):
        self.processes, self.samples = processes, []
        self.sample()
        self.feeder = Feeder(self.sample)

    def sample(self, _=0):
        total = sum(map(run_delay, self.processes))
        self.samples.append((time.time_ns(), total))

    def until(self, moment):
        """From the begin until a moment [ns]. [s]"""
        later = [total for at, total in self.samples if at >= moment] + [self.samples[-1][1]]
        return max(0, later[0] - self.samples[0][1]) / 1e9

    def silences(self, seconds):
        """The most pauses of this length [s] that their waits may have caused."""
        return int(self.until(time.time_ns()) / seconds)
