#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The robot head's ears and mouth: microphone, speaker, speech."""

import os
import pathlib
import re
import shutil
import signal
import socket
import unittest

from bodies import Bodies, loudness, tone
from harness import free_port, listens, wait_until


class Sound(Bodies):
    def test_a_file_goes_through_microphone_and_speaker_unchanged(self):
        for channels in (1, 2):
            samples = tone(16000, 0.53, channels)
            self.write_wav("in.wav", samples, 16000, channels)
            self.shell(
                "hc microphone in.wav --channels %d --paced=false | "
                "hc speaker --device none --save out%d.wav" % (channels, channels)
            )
            self.assertEqual(self.read_wav("out%d.wav" % channels), (16000, channels, samples))

    def test_pieces_follow_one_another_in_time(self):
        self.write_wav("in.wav", tone(22050, 0.1), 22050)
        out = self.shell(
            "hc microphone in.wav --rate 22050 --paced=false | hc cat --raw | head -c 90"
        )
        self.assertRegex(out, r"^1 1 0 0 8 [0-9]{19} 100131 0 22 441 1\n")
        out = self.shell("hc microphone in.wav --rate 22050 --paced=false | hc cat --json")
        times = [int(time) for time in re.findall(r'"time":(\d+)', out)]
        self.assertEqual([b - a for a, b in zip(times, times[1:])], [20_000_000] * 4)

    def test_disk_driver_hears_what_is_played(self):
        samples = tone(16000, 0.5)
        self.write_wav("in.wav", samples, 16000)
        # From a file, so that no other process can be late: silence would be heard meanwhile.
        self.shell("hc microphone in.wav --paced=false >in.mtp")
        self.shell("SDL_AUDIODRIVER=disk SDL_DISKAUDIOFILE=heard.raw hc speaker --in in.mtp")
        heard = self.read_bytes("heard.raw")
        self.assertIn(samples.tobytes(), heard)

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

    def test_sound_without_a_rate_is_dropped_and_told_once(self):
        message = b"1 1 0 0 8 0 100130 0 0 1 1\n7\n"
        self.shell("hc speaker --device none --save out.wav", data=2 * message)
        self.assertEqual(
            self.err.count("sound dropped: coordinate system 0 has no sample rate"), 1, self.err
        )


def is_loud(path):
    """Whether a file of messages has sound: headers are ASCII, and silence is zeros."""
    return path.exists() and any(byte > 127 for byte in path.read_bytes())


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
            # Half a second of 440 Hz; a sound server that is late has gaps, each with some crossings
            # less or more.
            samples = self.read_wav("heard.wav")[2][-8000:]
            crossings = sum((a < 0) != (b < 0) for a, b in zip(samples, samples[1:]))
            return loudness(samples) > 2000 and abs(crossings - 440) <= 30

        wait_until(hears)

    def test_a_device_that_goes_and_comes_back(self):
        server = self.start_server()
        speaker = self.start_tone(free_port())
        ears = self.start("exec hc microphone --out mono=file:heard.mtp 2>ears", stdout=-3)
        heard = pathlib.Path(self.path("heard.mtp"))
        wait_until(lambda: is_loud(heard))
        self.kill_server(server)
        self.wait_for("loudspeaker disconnected; dropping sound")
        self.start_server()
        self.wait_for("loudspeaker connected; ")
        self.assertRegex(self.said(), r"speaker: loudspeaker connected; dropped [1-9]\d* messages")

        def ears_said():
            return self.read("ears")

        wait_until(lambda: "microphone: microphone connected" in ears_said())
        self.assertEqual(ears_said().count("microphone disconnected; retrying"), 1)
        size = heard.stat().st_size
        wait_until(lambda: heard.stat().st_size > size)
        self.assertEqual(self.said().count("disconnected"), 1)
        self.stop(speaker)
        self.stop(ears)

    def test_a_device_that_hangs_and_continues(self):
        server = self.start_server()
        speaker = self.start_tone(free_port())
        ears = self.start("exec hc microphone --out mono=file:heard.mtp 2>ears", stdout=-3)
        heard = pathlib.Path(self.path("heard.mtp"))
        ears_said = lambda: re.findall(
            r"microphone: (?:warning: )?microphone (unresponsive|resumed)", self.read("ears")
        )
        wait_until(lambda: is_loud(heard))
        for times in (1, 2):
            server.send_signal(signal.SIGSTOP)
            self.wait_for("loudspeaker unresponsive", times)
            wait_until(lambda: ears_said().count("unresponsive") >= times)
            server.send_signal(signal.SIGCONT)
            self.wait_for("loudspeaker resumed; ", times)
            wait_until(lambda: ears_said()[-1] == "resumed")
            size = heard.stat().st_size
            wait_until(lambda: heard.stat().st_size > size)
        # Each change is logged once. There may be more of them, and other lines, on a busy machine.
        loudspeaker = re.findall(r"loudspeaker (unresponsive|resumed)", self.said())
        for changes in (ears_said(), loudspeaker):
            count = len(changes)
            self.assertEqual(changes, (["unresponsive", "resumed"] * count)[:count])
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

    def test_the_last_text_is_named_without_the_blanks_around_it(self):
        self.shell(
            "hc send --text '  hello robot ' | hc speak --paced=false --out words=- | hc info"
        )
        self.assertIn('said 1 text, the last "hello robot"', self.err)

    def test_hostile_text_does_no_harm(self):
        texts = (b"\x01+99S hi \x00\x1b[2J", b"\xff\xfe\xc0\x80", b"<speak>a</speak>", b" ", b"")
        data = b""
        for text in texts:
            data += b"1 1 0 0 8 5 60100 0 30 %d 1\n%s\n" % (len(text), text)
        out = self.shell("hc speak --paced=false --out sound=- | hc info", data=data)
        self.assertRegex(out, r"sound \d+ x 1 of 1 x i16")
        long = b"1 1 0 0 8 5 60100 0 30 200000 1\n%s\n" % (b"ab " * 66666 + b"ab")
        self.shell("hc speak --voice no_such --out sound=file:sound.mtp", data=2 * long)
        self.assertEqual(self.err.count('speak: no voice "no_such"'), 1, self.err)

    def test_texts_that_come_meanwhile_wait_and_the_newest_are_kept(self):
        data = b""
        for i, word in enumerate((b"one", b"two", b"three", b"four", b"five")):
            data += b"1 1 0 %d 8 %d 60100 0 30 %d 1\n%s\n" % (i, i + 1, len(word), word)
        out = self.shell("hc speak --waiting 2 --out words=- | hc cat --json", data=data)
        self.assertEqual(re.findall(r'"time":(\d+)', out), ["1", "4", "5"])
        self.assertIn("speak: 2 texts dropped", self.err)
        out = self.shell(
            "hc speak --waiting 2 --paced=false --out words=- | hc cat --json", data=data
        )
        self.assertEqual(re.findall(r'"time":(\d+)', out), ["1", "2", "3", "4", "5"])


if __name__ == "__main__":
    unittest.main()
