# SPDX-License-Identifier: Apache-2.0
"""Runs the processes of one case and measure, and RouDi for iceoryx; leaves nothing behind."""

import ctypes
import fcntl
import glob
import json
import math
import os
import re
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time

PATIENCE = 6  # until processes are ready, and until they end after their time [s]
ROUDI_CONFIG = """[general]
version = 1
[[segment]]
[[segment.mempool]]
size = 128
count = 10000
[[segment.mempool]]
size = 66048
count = 100
[[segment.mempool]]
size = 1500032
count = 100
"""
# What peers leave in /dev/shm when they are killed, and our floor.
SHARED_MEMORY = ["hc_bench_*", "fastrtps_*", "sem.fastrtps_*", "fast_datasharing_*", "iceoryx_mgmt"]


class Failed(Exception):
    """A case did not do a measure; says why in a few words."""


def _shared_memory():
    return {path for name in SHARED_MEMORY for path in glob.glob("/dev/shm/" + name)}


def start_cleaner(folder):
    """A process that cleans up when this one ends, however it does, or closes the pipe: that and
    its process number are returned."""
    before = _shared_memory()
    reading, writing = os.pipe()
    process = os.fork()
    if process:
        os.close(reading)
        return writing, process
    os.setsid()  # what interrupts the others does not interrupt it
    os.close(writing)
    os.read(reading, 1)
    shutil.rmtree(folder, ignore_errors=True)
    for path in _shared_memory() - before:
        os.unlink(path)
    os._exit(0)


class Process:
    def __init__(self, command, environment={}, processor=None, last_signal=signal.SIGKILL):
        def prepare():
            pr_set_pdeathsig = 1  # when the parent dies, however it does
            ctypes.CDLL(None).prctl(pr_set_pdeathsig, last_signal)
            if processor is not None:
                os.sched_setaffinity(0, {processor % os.cpu_count()})

        self.errors = tempfile.TemporaryFile()
        self.pending = b""
        self.popen = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self.errors,
            env={**os.environ, **environment},
            preexec_fn=prepare,
        )

    def why(self):
        self.errors.seek(0)
        lines = self.errors.read().decode(errors="replace").strip().splitlines()
        return lines[-1][:100] if lines else "it ended"

    def take_line(self):
        """The next line that is ours, of what has come; peers print theirs between."""
        while b"\n" in self.pending:
            line, _, self.pending = self.pending.partition(b"\n")
            line = line.removeprefix(b"ask: ")  # a module's
            if line == b"ready" or line.startswith(b"{"):
                return line.decode()
        return None

    def read(self):
        chunk = os.read(self.popen.stdout.fileno(), 65536)
        if not chunk:
            raise Failed(self.why())
        self.pending += chunk

    def signal(self):
        try:
            self.popen.stdin.write(b"\n")
            self.popen.stdin.flush()
        except BrokenPipeError as error:
            raise Failed(self.why()) from error

    def end(self, timeout):
        try:
            self.popen.stdin.close()
        except BrokenPipeError:
            pass
        try:
            self.popen.wait(timeout)
        except subprocess.TimeoutExpired:
            self.popen.kill()
            self.popen.wait()
        self.popen.stdout.close()
        self.errors.close()


def free_ports(count=8, first=[20000]):
    """The first of some neighbouring ports, below those that the system gives away."""
    while True:
        first[0] = 20000 + (first[0] - 20000 + count) % 10000
        try:
            for port in range(first[0], first[0] + count):
                with socket.socket() as one:
                    one.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                    one.bind(("127.0.0.1", port))
            return first[0]
        except OSError:
            continue


class Runner:
    """A context: what it made is removed at its end."""

    def __init__(self, programs, seconds):
        self.programs, self.seconds = programs, seconds
        self.roudi, self.count = None, 0

    def __enter__(self):
        # Two at once would measure each other, and there can be one RouDi only.
        self.lock = open(os.path.join(tempfile.gettempdir(), "hc_bench.lock"), "a")
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            print("waiting for another benchmark to end", file=sys.stderr)
            fcntl.flock(self.lock, fcntl.LOCK_EX)
        self.folder = tempfile.mkdtemp(prefix="hc_bench_")
        self.cleaner = start_cleaner(self.folder)
        hc = os.path.join(self.programs, "../../bin/hc")
        subprocess.run([hc, "key", os.path.join(self.folder, "key.pem")], check=True, stdout=-3)
        return self

    def __exit__(self, *_):
        self.stop_roudi()
        os.close(self.cleaner[0])
        os.waitpid(self.cleaner[1], 0)

    def start_roudi(self):
        config = os.path.join(self.folder, "roudi.toml")
        with open(config, "w") as file:
            file.write(ROUDI_CONFIG)
        # Without monitoring, which takes a process for dead that a busy machine kept waiting.
        command = ["iox-roudi", "-c", config, "-m", "off"]
        self.roudi = Process(command, last_signal=signal.SIGTERM)
        deadline = time.monotonic() + PATIENCE
        while b"RouDi is ready" not in self.roudi.pending:
            if not select.select([self.roudi.popen.stdout], [], [], deadline - time.monotonic())[0]:
                raise Failed("RouDi does not start")
            self.roudi.read()

    def stop_roudi(self):
        if self.roudi:
            self.roudi.popen.terminate()
            self.roudi.end(PATIENCE)
        self.roudi = None

    def run_graph(self, case, measure):
        """The numbers that a module logs as its result."""
        name = "l%d_%d" % (os.getpid(), self.count)
        path = os.path.join(self.folder, name + ".toml")
        options = dict(argument.split("=") for argument in case.arguments)
        program = os.path.join(self.programs, case.program)
        with open(path, "w") as file:
            file.write(graph_of(program, name, measure, self.seconds, **options))
        hc = os.path.join(self.programs, "../../bin/hc")
        process = Process(["sh", "-c", "exec %s run %s 2>&1 >/dev/null" % (hc, path)])
        try:
            deadline = time.monotonic() + 2 * self.seconds + PATIENCE
            return json.loads(await_line(process, [process], deadline))
        finally:
            process.popen.terminate()
            process.end(PATIENCE)

    def run_ddsperf(self, case, measure):
        """The last of the numbers that Cyclone DDS's own program prints each second."""
        roles = ("pong", "ping") if measure.is_latency else ("sub", "pub")
        size = ["size", str(measure.bytes)]
        common = ["ddsperf", "-i", "91", "-D", "%d" % (2 + math.ceil(self.seconds))]
        mode = list(case.arguments)
        commands = [
            [*common, roles[0], *mode],
            [*common, roles[1], *size, *(mode if measure.is_latency else [])],
        ]
        try:
            started = [
                Process(
                    each, case.environment, i % measure.processors if measure.processors else None
                )
                for i, each in enumerate(commands)
            ]
        except FileNotFoundError as error:
            raise Failed("no ddsperf: install cyclonedds-tools") from error
        printed = [process.popen.stdout.read().decode() for process in started]
        for process in started:
            process.end(PATIENCE)
        if measure.is_latency:
            found = re.findall(r" 50% ([\d.]+)us .* 99% ([\d.]+)us", printed[1])
            if found:
                return {"median_us": float(found[-1][0]), "p99_us": float(found[-1][1])}
        found = re.findall(
            r"^\S+ ([\d.]+)  size .* delta (\d+) lost (\d+)", printed[0], re.MULTILINE
        )
        if len(found) < 2:
            raise Failed("it printed no numbers")
        (begin, _, _), (end, count, lost) = found[-2:]
        return {"per_second": int(count) / (float(end) - float(begin)), "lost": int(lost)}

    def run(self, case, measure):
        """The numbers of one run. Raises Failed."""
        program = os.path.join(self.programs, case.program)
        if case.program == "floor_memcpy":
            done = subprocess.run([program, str(measure.bytes), str(self.seconds)], stdout=-1)
            return json.loads(done.stdout)
        if case.program == "ddsperf":
            return self.run_ddsperf(case, measure)
        if case.needs_roudi and not self.roudi:
            self.start_roudi()
        self.count += 1
        if case.kind == "module":
            return self.run_graph(case, measure)
        common = [
            "link=l%d_%d" % (os.getpid(), self.count),
            "folder=" + self.folder,
            "port=%d" % free_ports(),
            "bytes=%d" % measure.bytes,
            "seconds=%g" % self.seconds,
            "readers=%d" % measure.readers,
            *case.arguments,
        ]
        if measure.is_latency:
            roles = [["role=ping"], ["role=pong"]]
        else:
            readers = range(measure.readers)
            roles = [["role=publish"]] + [["role=subscribe", "reader=%d" % i] for i in readers]
        processes, failed = [], True
        try:
            for i, role in enumerate(roles):
                processor = i % measure.processors if measure.processors else None
                command = [program, *role, *common]
                processes.append(Process(command, case.environment, processor))
            found = measure_once(processes, measure, self.seconds)
            failed = False
            return found
        finally:
            for process in processes:
                if failed:
                    process.popen.kill()
            for process in processes:
                process.end(PATIENCE / 5)
            if failed and case.needs_roudi:
                self.stop_roudi()  # it does not clean up after processes that were killed


def graph_of(program, name, measure, seconds, spin, ports, rate):
    """A graph file of two modules that send messages to and fro."""
    text = "version = 1\n"
    for module, other, processor in (("ask", "answer", 0), ("answer", "ask", 1)):
        text += "[modules.%s]\nprogram = '%s'\n" % (module, program)
        text += (
            "parameters = { asks = %s, bytes = %d, seconds = %g, processor = %d, ports = %s, "
            "rate = %s }\n"
            % (
                "true" if module == "ask" else "false",
                measure.bytes,
                seconds,
                processor % measure.processors,
                ports,
                rate,
            )
        )
        for port in range(int(ports)):
            link = "shm:%s_%%s%d" % (name, port)
            text += "outputs.out%d = '%s?readers=1&stay=1'\n" % (port, link % module)
            text += "inputs.in%d = '%s?reconnect=60&spin=%s'\n" % (port, link % other, spin)
    return text


def await_line(process, processes, deadline):
    """The next line of a process; Failed when one of all processes ends before."""
    outputs = {one.popen.stdout: one for one in processes}
    while (line := process.take_line()) is None:
        left = deadline - time.monotonic()
        ready = select.select(list(outputs), [], [], max(left, 0))[0]
        if not ready:
            raise Failed("no answer")
        for output in ready:
            outputs[output].read()
    return line


def measure_once(processes, measure, seconds):
    """The numbers that processes measure, the first of which pings or publishes."""
    first, *others = processes
    deadline = time.monotonic() + PATIENCE
    for process in processes:
        await_line(process, processes, deadline)
    for process in reversed(processes):
        process.signal()
    deadline = time.monotonic() + 2 * seconds + PATIENCE
    found = json.loads(await_line(first, processes, deadline))
    if measure.is_latency:
        others[0].signal()
        await_line(others[0], processes, deadline)
        first.signal()  # to send the last
        return found
    readers = [json.loads(await_line(other, processes, deadline)) for other in others]
    found = min(readers, key=lambda reader: reader["per_second"])
    if found["per_second"] == 0:
        raise Failed("stalls")
    found["lost"] = sum(reader["lost"] for reader in readers)
    return found
