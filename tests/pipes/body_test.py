#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What joins the robot head to a person: head tracker, joystick, microphone, speaker, speech."""

import array
import math
import os
import pathlib
import re
import shutil
import signal
import socket
import struct
import unittest
import wave

from harness import WATCHDOG, Pipes, free_port, listens, wait_until


def tone(rate, seconds, channels=1, hertz=440):
    """A tone as samples of i16, the same in all channels."""
    samples = array.array("h")
    for i in range(int(rate * seconds)):
        samples.extend([int(8000 * math.sin(2 * math.pi * hertz * i / rate))] * channels)
    return samples


def loudness(samples):
    return sum(map(abs, samples)) / max(1, len(samples))


class Bodies(Pipes):
    """Programs that run, what they say, and what they have written so far."""

    def run_module(self, command):
        """Starts a module that says its lines into a file."""
        return self.start("exec " + command + " 2>said", stdout=-3)

    def said(self):
        return self.read("said")

    def wait_for(self, line, times=1):
        """Waits until a line has been said so often."""
        wait_until(lambda: self.said().count(line) >= times)

    def rows(self, name):
        """The elements of a file of messages with a row each, as numbers."""
        lines = self.read(name).split("\n")[:-1]
        return [list(map(float, line.split())) for line in lines[1::2]]

    def stop(self, process, status=0):
        os.killpg(process.pid, signal.SIGTERM)
        self.assertEqual(process.wait(timeout=WATCHDOG), status, self.said())

    def write_wav(self, name, samples, rate, channels=1):
        with wave.open(self.path(name), "wb") as file:
            file.setnchannels(channels)
            file.setsampwidth(2)
            file.setframerate(rate)
            file.writeframes(samples.tobytes())

    def read_wav(self, name):
        """Rate, channels and samples of a file that is whole."""
        with wave.open(self.path(name), "rb") as file:
            data = file.readframes(file.getnframes())
            return file.getframerate(), file.getnchannels(), array.array("h", data)


class HeadTracker(Bodies):
    def setUp(self):
        super().setUp()
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(self.socket.close)

    def start_tracker(self, options=""):
        process = self.run_module(
            "hc head_tracker --port 0 --out rotation=file:rotation --out position=file:position "
            + options
        )
        self.wait_for("listens at UDP")
        self.port = int(re.search(r"listens at UDP \S+:(\d+)", self.said())[1])
        return process

    def send(self, *numbers):
        self.socket.sendto(struct.pack("<6d", *numbers), ("127.0.0.1", self.port))

    def feed(self, *numbers):
        """Sends a pose, and waits until it has come through."""
        before = len(self.rows("position"))
        self.send(*numbers)
        wait_until(lambda: len(self.rows("position")) > before)
        return self.rows("rotation")[-1], self.rows("position")[-1]

    def assert_close(self, found, expected):
        self.assertEqual(len(found), len(expected))
        for a, b in zip(found, expected):
            self.assertAlmostEqual(a, b, places=9)

    def test_signs_units_and_the_first_pose_as_zero(self):
        process = self.start_tracker()
        rotation, position = self.feed(1, 2, 3, 0, 0, 0)
        self.assert_close(rotation + position, [0] * 6)
        # To the right and up, tilted; 10 cm right, 20 cm up, 30 cm back.
        rotation, position = self.feed(11, 22, 33, 30, 20, 10)
        self.assert_close(rotation, [math.radians(a) for a in (10, -20, -30)])
        self.assert_close(position, [-0.3, -0.1, 0.2])
        header = self.read("rotation").split()
        self.assertEqual(header[6:11], ["20390", "0", "14", "1", "1"])
        self.assertGreater(int(header[5]), 1_600_000_000_000_000_000)
        self.stop(process)

    def test_is_centred_by_any_message(self):
        port = free_port()
        process = self.start_tracker("--centre_first=false --in centre=tcp-listen:%d" % port)
        rotation, _ = self.feed(0, 0, 0, -40, 0, 0)
        self.assert_close(rotation, [0, 0, math.radians(40)])
        self.shell("hc send --out tcp:127.0.0.1:%d 1" % port)
        wait_until(lambda: abs(self.feed(0, 0, 0, -40, 0, 0)[0][2]) < 1e-9)
        rotation, _ = self.feed(0, 0, 0, -50, 0, 0)
        self.assert_close(rotation, [0, 0, math.radians(10)])
        self.assertNotIn("first pose", self.said())
        self.stop(process)

    def test_what_the_first_pose_makes_the_zero_is_told(self):
        process = self.start_tracker()
        self.feed(0, 0, 0, -40, 0, 0)
        self.feed(0, 0, 0, -50, 0, 0)
        zero = "is the zero: the tracker's roll 0.00, pitch 0.00, yaw 0.70 rad\n"
        self.assertEqual(self.said().count(zero), 1, self.said())
        self.stop(process)

    def test_a_port_in_use_is_told_once_and_waited_for(self):
        self.socket.bind(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        process = self.run_module(
            "hc head_tracker --port %d --out rotation=file:rotation --out position=file:position"
            % self.port
        )
        self.wait_for("UDP port %d of 127.0.0.1: Address already in use; trying again" % self.port)
        self.socket.close()
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(self.socket.close)
        self.wait_for("listens at UDP 127.0.0.1:%d" % self.port)
        self.feed(0, 0, 0, 0, 0, 0)
        self.stop(process)
        self.assertEqual(self.said().count("trying again"), 1, self.said())

    def test_garbage_is_ignored_told_once_and_counted(self):
        process = self.start_tracker()
        self.send(0, 0, 0, math.nan, 0, 0)
        self.send(math.inf, 0, 0, 0, 0, 0)
        for size in (0, 1, 47, 49, 5000):
            self.socket.sendto(b"x" * size, ("127.0.0.1", self.port))
        self.feed(1, 1, 1, 1, 1, 1)
        self.assertEqual(len(self.rows("rotation")), 1)
        self.stop(process)
        self.assertEqual(self.said().count("ignores"), 1, self.said())
        self.assertIn("head_tracker: 7 packets ignored", self.said())

    def test_a_flood_of_packets_costs_no_memory_and_no_pose(self):
        process = self.start_tracker()

        def memory():  # [kB]
            text = pathlib.Path("/proc/%d/status" % process.pid).read_text()
            return int(re.search(r"VmRSS:\s*(\d+)", text)[1])

        self.feed(0, 0, 0, 0, 0, 0)
        before = memory()
        good = struct.pack("<6d", 0, 0, 0, 10, 0, 0)
        bad = b"x" * 49, struct.pack("<6d", *[math.nan] * 6), b"", b"y" * 1400
        for number in range(100_000):
            self.socket.sendto(
                bad[number % 8 // 2] if number % 2 else good, ("127.0.0.1", self.port)
            )
        turned = lambda: abs(self.rows("rotation")[-1][2] - math.pi / 2) < 1e-9
        wait_until(lambda: self.send(0, 0, 0, -90, 0, 0) or turned())
        self.assertLess(memory() - before, 10_000)
        self.assertEqual(
            {round(math.degrees(row[2])) for row in self.rows("rotation")}, {0, -10, 90}
        )
        self.stop(process)
        self.assertEqual(self.said().count("ignores"), 1, self.said())
        self.assertRegex(self.said(), r"head_tracker: \d+ packets ignored")

    def test_silence_and_return_are_told_once_each(self):
        process = self.start_tracker("--silence 0.1")
        self.wait_for("no tracker is heard", 1)
        self.feed(0, 0, 0, 0, 0, 0)
        self.wait_for("hears a tracker", 1)
        self.wait_for("no tracker is heard", 2)
        self.assertEqual(len(self.rows("rotation")), 1)  # nothing is sent meanwhile
        self.feed(0, 0, 0, 0, 0, 0)
        self.wait_for("hears a tracker", 2)
        self.stop(process)
        lines = [
            line for line in self.said().splitlines() if "tracker is" in line or "hears" in line
        ]
        for before, after in zip(lines, lines[1:]):
            self.assertNotEqual(before, after)

    def test_a_host_that_is_none_is_a_clear_error(self):
        self.shell("hc head_tracker --host nowhere.invalid --port 0", status=2)
        self.assertIn('head_tracker: Usage: host "nowhere.invalid": ', self.err)


class Joystick(Bodies):
    def test_waits_where_there_is_none(self):
        process = self.run_module("hc joystick --out stick=file:stick --out buttons=file:buttons")
        wait_until(lambda: self.said() or process.poll() is not None)
        self.assertIsNone(process.poll())
        if "waits for one" in self.said():  # a machine with a joystick says its name
            self.assertEqual(self.rows("stick"), [])
        self.stop(process)


class Sound(Bodies):
    def test_a_file_goes_through_microphone_and_speaker_unchanged(self):
        for channels in (1, 2):
            samples = tone(16000, 0.53, channels)
            self.write_wav("in.wav", samples, 16000, channels)
            self.shell(
                "hc microphone in.wav --channels %d --paced=false | "
                "hc speaker --device none --save out.wav" % channels
            )
            self.assertEqual(self.read_wav("out.wav"), (16000, channels, samples))

    def test_pieces_follow_one_another_in_time(self):
        self.write_wav("in.wav", tone(22050, 0.1), 22050)
        out = self.shell(
            "hc microphone in.wav --rate 22050 --paced=false | hc cat --raw | head -c 90"
        )
        self.assertRegex(out, r"^1 1 0 0 8 [0-9]{19} 100131 0 22 441 1\n")
        out = self.shell("hc microphone in.wav --rate 22050 --paced=false | hc cat --json")
        times = [int(time) for time in re.findall(r'"time":(\d+)', out)]
        self.assertEqual([b - a for a, b in zip(times, times[1:])], [20_000_000] * 4)

    def test_a_paced_file_takes_its_time(self):
        self.write_wav("in.wav", tone(8000, 0.3), 8000)
        self.shell(
            "hc microphone in.wav --rate 8000 >paced.mtp; hc microphone in.wav --rate 8000 "
            "--paced=false >fast.mtp"
        )
        paced = self.read_bytes("paced.mtp")
        fast = self.read_bytes("fast.mtp")
        self.assertEqual(len(paced), len(fast))

    def test_what_is_no_wav_file_is_refused(self):
        self.write("no.wav", b"RIFF\xff\xff\xff\xffWAVEfmt ")
        self.shell("hc microphone no.wav", status=1)
        self.assertIn("microphone: Malformed: no.wav: has no samples", self.err)
        self.shell("hc microphone gone.wav", status=1)
        self.assertIn("microphone: NotFound: gone.wav: No such file", self.err)
        self.shell("hc microphone --rate 11025", status=2)
        self.assertIn("11025 is not 8000, 16000, 22050, 44100 or 48000", self.err)

    def test_disk_driver_hears_what_is_played(self):
        samples = tone(16000, 0.5)
        self.write_wav("in.wav", samples, 16000)
        self.shell(
            "hc microphone in.wav --paced=false | "
            "SDL_AUDIODRIVER=disk SDL_DISKAUDIOFILE=heard.raw hc speaker"
        )
        heard = self.read_bytes("heard.raw")
        self.assertIn(samples.tobytes(), heard)

    def test_a_file_is_whole_after_the_speaker_was_killed_and_gone_on_with(self):
        samples = tone(8000, 0.2)
        self.write_wav("in.wav", samples, 8000)
        path = pathlib.Path(self.path("out.wav"))
        for times in 1, 2, 3:
            port = free_port()
            process = self.run_module(
                "hc speaker --device none --save out.wav --in tcp-listen:%d" % port
            )
            wait_until(lambda: listens(port))
            self.shell(
                "hc microphone in.wav --rate 8000 --paced=false --out mono=tcp:127.0.0.1:%d" % port
            )
            size = 44 + 2 * len(samples) * times
            wait_until(lambda: path.exists() and path.stat().st_size == size)
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            self.assertEqual(self.read_wav("out.wav"), (8000, 1, samples * times))

    def test_a_long_sound_does_not_keep_the_speaker_from_its_end(self):
        port = free_port()
        process = self.run_module(
            "env SDL_AUDIODRIVER=dummy hc speaker --save out.wav --in tcp-listen:%d" % port
        )
        wait_until(lambda: listens(port))
        frames = 600 * 8000
        message = b"1 1 0 0 8 0 100131 0 20 %d 1\n" % frames + bytes(2 * frames) + b"\n"
        with socket.create_connection(("127.0.0.1", port)) as connection:
            connection.sendall(2 * message)
            path = pathlib.Path(self.path("out.wav"))
            # The second waits until there is room for it.
            wait_until(lambda: path.exists() and path.stat().st_size == 44 + 4 * frames)
            self.stop(process)

    def test_without_a_device_sound_is_dropped_and_counted(self):
        self.write_wav("in.wav", tone(16000, 0.1), 16000)
        self.shell(
            "hc microphone in.wav --paced=false | "
            "SDL_AUDIODRIVER=no_such_driver hc speaker --save out.wav"
        )
        self.assertEqual(self.err.count("speaker: no sound: "), 1, self.err)
        self.assertIn("speaker: 5 messages were not heard", self.err)
        self.assertEqual(len(self.read_wav("out.wav")[2]), 1600)

    def test_sound_without_a_rate_is_left_out_and_told_once(self):
        message = b"1 1 0 0 8 0 100130 0 0 1 1\n7\n"
        self.shell("hc speaker --device none --save out.wav", data=2 * message)
        self.assertEqual(self.err.count("leaves out sound of coordinate system 0"), 1, self.err)


@unittest.skipUnless(shutil.which("pulseaudio"), "PulseAudio is not installed")
class SoundServer(Bodies):
    def start_server(self):
        os.makedirs(self.path("run"), exist_ok=True)
        self.environment.update(
            XDG_RUNTIME_DIR=self.path("run"),
            HOME=self.path("run"),
            PULSE_SERVER="unix:" + self.path("run/pulse/native"),
            SDL_AUDIODRIVER="pulseaudio",
            PULSE_SINK="robot",
            PULSE_SOURCE="ears",
        )
        server = self.start(
            "exec pulseaudio -n --daemonize=no --exit-idle-time=-1 --use-pid-file=no"
            " -L module-native-protocol-unix -L 'module-null-sink sink_name=robot'"
            " -L 'module-remap-source master=robot.monitor source_name=ears' 2>server",
            stdout=-3,
        )
        wait_until(lambda: os.path.exists(self.path("run/pulse/native")) or server.poll())
        self.assertIsNone(server.poll(), self.read("server"))
        return server

    def kill_server(self, server):
        os.killpg(server.pid, signal.SIGKILL)
        server.wait()
        os.unlink(self.path("run/pulse/native"))

    def start_tone(self, port):
        """A speaker, and a tone for it that does not end; both are to be killed."""
        speaker = self.run_module("hc speaker --in tcp-listen:%d" % port)
        wait_until(lambda: listens(port))
        self.write_wav("in.wav", tone(16000, 60), 16000)
        self.start("exec hc microphone in.wav --out mono=tcp:127.0.0.1:%d 2>&1" % port, stdout=-3)
        return speaker

    def test_what_is_played_is_heard(self):
        self.start_server()
        self.start_tone(free_port())
        self.start(
            "exec hc microphone --out mono=- 2>ears | hc speaker --device none --save heard.wav",
            stdout=-3,
        )
        path = pathlib.Path(self.path("heard.wav"))

        def hears():
            if not path.exists() or path.stat().st_size < 44 + 32000:
                return False
            return loudness(self.read_wav("heard.wav")[2][-8000:]) > 2000

        wait_until(hears)
        samples = self.read_wav("heard.wav")[2][-8000:]
        crossings = sum((a < 0) != (b < 0) for a, b in zip(samples, samples[1:]))
        self.assertAlmostEqual(crossings, 440, delta=10)  # half a second of 440 Hz

    def test_a_device_that_goes_and_comes_back(self):
        server = self.start_server()
        speaker = self.start_tone(free_port())
        ears = self.start("exec hc microphone --out mono=file:heard.mtp 2>ears", stdout=-3)
        heard = pathlib.Path(self.path("heard.mtp"))
        wait_until(lambda: heard.exists() and heard.stat().st_size > 0)
        self.kill_server(server)
        self.wait_for("the loudspeaker has gone; what comes is dropped until it is back")
        self.start_server()
        self.wait_for("the loudspeaker is there; ")
        self.assertRegex(self.said(), r"speaker: the loudspeaker is there; [1-9]\d* messages were")

        def ears_said():
            return self.read("ears")

        wait_until(lambda: "microphone: the microphone is there" in ears_said())
        self.assertEqual(ears_said().count("the microphone has gone; looks for it"), 1)
        size = heard.stat().st_size
        wait_until(lambda: heard.stat().st_size > size)
        self.assertEqual(self.said().count("has gone"), 1)
        self.stop(speaker)
        self.stop(ears)

    def test_a_device_that_hangs_and_goes_on(self):
        server = self.start_server()
        speaker = self.start_tone(free_port())
        ears = self.start("exec hc microphone --out mono=file:heard.mtp 2>ears", stdout=-3)
        heard = pathlib.Path(self.path("heard.mtp"))
        ears_said = lambda: pathlib.Path(self.path("ears")).read_text().splitlines()
        wait_until(lambda: heard.exists() and heard.stat().st_size > 0)
        for times in (1, 2):
            server.send_signal(signal.SIGSTOP)
            self.wait_for("the loudspeaker takes no sound; what comes is dropped until", times)
            wait_until(lambda: len(ears_said()) == 2 * times - 1)
            server.send_signal(signal.SIGCONT)
            self.wait_for("the loudspeaker takes sound again; ", times)
            wait_until(lambda: len(ears_said()) == 2 * times)
            size = heard.stat().st_size
            wait_until(lambda: heard.stat().st_size > size)
        change = ["microphone: the microphone gives nothing; waits for it"]
        change += ["microphone: the microphone gives sound again"]
        self.assertEqual(ears_said(), 2 * change)
        self.assertEqual(len(self.said().splitlines()), 4, self.said())
        self.stop(speaker)
        self.stop(ears)


class Speech(Bodies):
    WORDS = "hello robot seven window"
    GRAMMAR = """#JSGF V1.0;
grammar words;
public <words> = (hello | robot | seven | window | yellow | river | tomorrow | eleven)+;
"""

    def speak(self, text, options=""):
        self.shell(
            "hc send --text '%s' | hc speak %s --out sound=- --out words=file:words.mtp | "
            "hc speaker --device none --save said.wav --rate 16000" % (text, options)
        )
        rows = self.read_bytes("words.mtp")
        header, elements = rows.split(b"\n", 1)
        width, height = map(int, header.split()[-2:])
        cut = [elements[i * width : (i + 1) * width] for i in range(height)]
        return [row.decode().split() for row in cut]

    def test_words_are_loud_where_they_are_said_to_be(self):
        words = self.speak(self.WORDS)
        self.assertEqual([word for _, _, word in words], self.WORDS.split())
        rate, channels, samples = self.read_wav("said.wav")
        self.assertEqual((rate, channels), (16000, 1))
        last = 0
        for start, end, _ in words:
            start, end = float(start), float(end)
            self.assertGreaterEqual(start, last)
            self.assertGreater(loudness(samples[int(start * rate) : int(end * rate)]), 300)
            last = end
        self.assertLessEqual(last, len(samples) / rate + 0.01)

    @unittest.skipUnless(shutil.which("pocketsphinx_continuous"), "PocketSphinx is not installed")
    def test_a_listener_understands(self):
        # Of a grammar of eight words in any order: a synthetic voice is too far from those that
        # the free model of English was trained with.
        self.speak(self.WORDS)
        self.write("words.gram", self.GRAMMAR)
        heard = self.shell("pocketsphinx_continuous -infile said.wav -jsgf words.gram 2>/dev/null")
        self.assertEqual(heard.split(), self.WORDS.split())

    def test_hostile_text_does_no_harm(self):
        texts = (b"\x01+99S hi \x00\x1b[2J", b"\xff\xfe\xc0\x80", b"<speak>a</speak>", b" ", b"")
        data = b""
        for text in texts:
            data += b"1 1 0 0 8 5 60100 0 30 %d 1\n%s\n" % (len(text), text)
        out = self.shell("hc speak --paced=false --out sound=- | hc info", data=data)
        self.assertIn("sound 1 x i16", out)
        long = b"1 1 0 0 8 5 60100 0 30 200000 1\n%s\n" % (b"ab " * 66666 + b"ab")
        self.shell("hc speak --voice no_such --out sound=file:sound.mtp", data=2 * long)
        self.assertEqual(self.err.count('speak: there is no voice "no_such"'), 1, self.err)

    def test_texts_that_come_meanwhile_wait_and_the_newest_are_kept(self):
        data = b""
        for i, word in enumerate((b"one", b"two", b"three", b"four", b"five")):
            data += b"1 1 0 %d 8 %d 60100 0 30 %d 1\n%s\n" % (i, i + 1, len(word), word)
        out = self.shell("hc speak --waiting 2 --out words=- | hc cat --json", data=data)
        self.assertEqual(re.findall(r'"time":(\d+)', out), ["1", "4", "5"])
        self.assertIn("speak: 2 texts were left out", self.err)
        out = self.shell(
            "hc speak --waiting 2 --paced=false --out words=- | hc cat --json", data=data
        )
        self.assertEqual(re.findall(r'"time":(\d+)', out), ["1", "2", "3", "4", "5"])


if __name__ == "__main__":
    unittest.main()
