#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Each task of the simulated head is recorded whole. Then every module of it that has inputs runs
alone, on the recording, by the clock of its messages, and what it sends is compared to what it sent.

What is compared how:

- What a module makes of each message alone (images, targets, sound, scores) is the same to the
  byte, in all messages that have the same time.
- What it does by the clock (commands, bids, the focus) has times of its own, so a message counts as
  the same if one of the replay with the same numbers is near it in time. Numbers and times may
  differ by what is said where they are compared: a recording says when things were sensed, and not
  that the module heard of them up to 0.1 s later, more on a busy machine; that is why a share of
  the messages may differ, too.

Modules without inputs that a graph links (fake_pan_tilt, head_tracker) have nothing to be fed with.
The streams `device` and `address` are not fed to pan_tilt and fake_head_tracker: they name a
pseudo-terminal and a port that have gone, or are somebody else's by now.
"""

import math
import os
import pathlib
import re
import unittest

from harness import Pipes, wait_until
from recordings import Late, Task, numbers, read_messages, record_again, share_within

DEGREE = math.pi / 180


class Recording(Pipes):
    def assert_at_least(self, value, least, what):
        if value < least:
            raise Late("%s: %g is less than %g" % (what, value, least))

    def record(self, task, *settings):
        """Runs the task to the end of its score; gives the line of figures of it."""
        self.task = Task(task, settings)
        os.mkdir(self.path("again"))
        self.fed = set()
        self.shell(self.task.record_command())
        for output in self.task.recorded():
            self.assertGreater(os.path.getsize(self.path("kept/%s.mtp" % output)), 0, output)
        lines = re.findall(r"^\w+_score: (.*\d.*)$", self.err, re.M)
        self.assertTrue(lines, self.err)
        return lines[-1]

    def replay(self, name, inputs=(), before="", after="", **parameters):
        self.fed.add(name)
        self.shell(before + self.task.replay_command(name, inputs, **parameters) + " " + after)
        return self.err

    def assert_all_were_fed(self):
        linked = {name for name in self.task.modules if self.task.has_inputs(name)}
        self.assertEqual(self.fed, linked)

    def messages(self, folder, output):
        return read_messages(self.path("%s/%s.mtp" % (folder, output)))

    def assert_same(self, output, at_least, share=1.0):
        """To the byte, header and elements, where times are the same."""
        kept = {message.time: message for message in self.messages("kept", output)}
        again = self.messages("again", output)
        common = [message for message in again if message.time in kept]
        self.assert_at_least(len(common), at_least, output)
        same = [message for message in common if kept[message.time] == message]
        if share == 1:
            self.assertEqual(len(same), len(common), output)
        self.assert_at_least(len(same), share * len(common), output)

    def assert_close(self, output, seconds, difference, share, begin=0.0):
        """As a function of time, either way, from so many seconds behind the first message on. Of
        the replay a half is enough: a recorded module that had to wait for its processor has said
        less."""
        kept, again = self.messages("kept", output), self.messages("again", output)
        later = [each for each in kept if each.time >= kept[0].time + begin * 1e9]
        self.assert_at_least(share_within(later, again, seconds, difference), share, output)
        self.assert_at_least(share_within(again, kept, seconds, difference), 0.5, output)

    def replay_workspace(self):
        """Who has the focus: changes may be a decision (50 ms) and a stall earlier or later."""
        self.replay("workspace")
        self.assert_close("workspace.focus", 0.25, 0, 0.95)
        for folder in ("kept", "again"):
            self.assertIn([1], [numbers(each) for each in self.messages(folder, "workspace.focus")])

    def replay_gaze(self, name, seconds, degrees):
        """Where it sends the head. While that is on its way to a target that has just come, it counts
        most when `gaze` heard of what."""
        self.replay(name)
        self.assert_close(name + ".command", max(seconds, 0.1), 1 * DEGREE, 0.9)
        self.assert_close(name + ".command", seconds, degrees * DEGREE, 0.85, begin=0.7)
        self.assert_close(name + ".bid", 0.25, 0, 0.95)
        first = self.messages("again", name + ".command")
        for path in pathlib.Path(self.path("again")).glob(name + ".*"):
            path.unlink()  # it would be kept
        self.replay(name)  # to the byte the same, since it goes by nothing but what it is fed with
        self.assertEqual(first, self.messages("again", name + ".command"))

    def first_time(self, output):
        return min(message.time for message in self.messages("kept", output))

    def replay_eyes(self, count):
        """Images of the same places of the head. One may have been drawn with a gaze that came
        late, or before a text that came at that moment."""
        start = self.first_time("head_eyes.left")
        self.replay("head_eyes", start=start, count=count)
        for output in self.task.recorded():
            if output.startswith("head_eyes."):
                self.assert_same(output, count // 2, 0.75)

    def replay_neck(self, command, seconds):
        """The neck at another simulated unit, in real time as that is. Both come to rest at the same
        places, one after the other."""
        self.start("hc fake_pan_tilt --out device=device.mtp")
        device = wait_until(lambda: self.device())
        play = "hc play kept/%s.mtp --to %s | " % (command, seconds)
        self.replay("head_neck", ["command=-"], play, device=device)
        kept, again = (
            # Without the rest at 0, in which a unit begins: that may be too short to be seen.
            [
                rest
                for rest in self.rests(self.messages(f, "head_neck.pose"))
                if max(map(abs, rest[4:9])) > 0.01
            ]
            for f in ("kept", "again")
        )
        self.assert_at_least(len(again), 1, "places where the head stood")
        for one, other in zip(kept, again):
            # One that was cut short by a stall is missing on one side.
            most = max(abs(a - b) for a, b in zip(one, other))
            self.assert_at_least(0.05 * DEGREE, most, "places where the head stood differ")

    def replay_hearing(self):
        """What the ears hear of the room's loudspeaker: from the right, while it sounds."""
        outputs = "--out level=again/level.mtp --out direction=again/direction.mtp"
        self.replay("head_hearing", after=outputs)
        levels = [numbers(each)[0] for each in self.messages("again", "level")]
        self.assertEqual(len(levels), len(self.messages("kept", "head_eyes.sound")))
        self.assertGreater(max(levels), 0.01)
        self.assertEqual(min(levels), 0)  # between its sounds
        pans = sorted(numbers(each)[2] for each in self.messages("again", "direction"))
        self.assertGreater(len(pans), len(levels) // 10)
        self.assertLess(pans[len(pans) // 2], -30 * DEGREE)

    def device(self):
        path = pathlib.Path(self.path("device.mtp"))
        lines = path.read_text().splitlines() if path.exists() else []
        return next((line for line in lines if line.startswith("/dev/")), None)

    @staticmethod
    def rests(gazes):
        """Where the head stood for 0.2 s, each place once."""
        places, since = [], None
        for gaze in gazes:
            at = numbers(gaze)
            if since is None or at != since[1]:
                since = (gaze.time, at)
            elif gaze.time - since[0] > 0.2e9 and places[-1:] != [at]:
                places.append(at)
        return places

    @record_again
    def test_calibrate(self):
        line = self.record("calibrate", "head_eyes.rate=5")
        self.replay_workspace()
        self.replay_eyes(8)
        self.replay("calibrate")
        # Each of nine places within 1e-9 rad of the recorded one, a late image (0.2 s) earlier.
        self.assert_close("calibrate.command", 0.3, 1e-9, 0.95)
        self.assert_close("calibrate.bid", 0.3, 0, 0.95)
        # Another image of the same place has other noise.
        kept, again = (self.messages(f, "calibrate.result")[0] for f in ("kept", "again"))
        for a, b in zip(numbers(kept)[:6], numbers(again)):
            self.assertAlmostEqual(a, b, delta=0.02 * DEGREE)
        self.assertIn(line, self.replay("calibrate_score"))
        self.replay_neck("calibrate.command", 3)
        self.fed.add("head_hearing")  # test_read
        self.assert_all_were_fed()

    @record_again
    def test_point(self):
        line = self.record("point", "point_score.count=4")
        self.replay_workspace()
        # In the 10 ms between two commands a full push turns the head by 0.57 degrees: it is off by
        # as much, until the next push, when it is heard of a command earlier or later.
        self.replay_gaze("point", 0.3, 0.6)
        # It pushes by what it sees of the head: to the same side and as far, but the first time as
        # soon as the head has stood, which it may have seen later then; so its delay is another.
        again = self.replay("point_score")
        self.assertIn(re.search("of 4 of . pushes", line)[0], again)
        pushes = []
        for folder in ("kept", "again"):
            got = self.messages(folder, "point_score.stick")
            got = [(each.time, numbers(each)) for each in got]
            pushes.append([b for a, b in zip([(0, None)] + got, got) if a[1] != b[1]])
        self.assertEqual(len(pushes[0]), 8)  # and let go
        for (kept, stick), (replayed, other) in zip(*pushes):
            self.assertEqual(stick, other)
            self.assert_at_least(0.3e9, abs(kept - replayed), "pushes differ in time")
        self.fed.update(["head_neck", "head_hearing"])  # test_calibrate, test_read
        self.fed.add("head_eyes")  # without an image that any module takes
        self.assert_all_were_fed()

    @record_again
    def test_telepresence(self):
        line = self.record("telepresence", "follow_score.settle=0.5", "follow_score.duration=1")
        self.replay_workspace()
        self.replay_gaze("telepresence", 0.01, 0.1)
        self.assertIn(line, self.replay("follow_score"))
        self.fed.update(["head_neck", "head_eyes", "head_hearing", "fake_head_tracker"])
        self.assert_all_were_fed()

    @record_again
    def test_track(self):
        line = self.record("track", "track_score.duration=2", "head_eyes.rate=10")
        self.replay_workspace()
        self.replay_eyes(8)
        for side in ("left", "right"):
            self.replay(side + "_ball")
            self.assert_same(side + "_ball.target", 10)
        self.replay_gaze("track", 0.05, 0.6)
        self.assertIn(line, self.replay("track_score"))
        self.fed.update(["head_neck", "head_hearing"])
        self.assert_all_were_fed()

    @record_again
    def test_read(self):
        # Read six times over, so that the head is given to `read` before the first text is sure.
        settings = ["head_eyes.rate=10", "read.repeat=6", "speak.rate=450", "speaker.save=said.wav"]
        line = self.record("read", "read_score.count=2", "read_score.pause=0.1", *settings)
        self.replay_workspace()
        self.replay_eyes(12)
        self.replay("read")
        self.assert_same("read.target", 10)
        # Which image decides depends on those that were dropped while it read.
        texts = [[m.elements for m in self.messages(f, "read.text")] for f in ("kept", "again")]
        self.assertGreaterEqual(len(texts[0]), 2)
        self.assertEqual(*texts)
        self.replay_gaze("look", 0.05, 0.6)
        self.replay("speak")
        self.assert_same("speak.sound", 1)
        self.replay("speaker", save="again.wav")
        said, again = (
            pathlib.Path(self.path(f)).read_bytes()[44:] for f in ("said.wav", "again.wav")
        )
        self.assertGreater(len(said), 11025)  # 1/4 s of 16 bits: the last may have been cut
        self.assertEqual(said, again[: len(said)])
        # It writes the same, and finds as many letters wrong; how long it took is not in a recording.
        self.assertIn(line.split(",")[0] + ",", self.replay("read_score"))
        writings = [self.messages(f, "read_score.writing") for f in ("kept", "again")]
        self.assertEqual(*[[m.elements for m in each] for each in writings])
        self.replay_hearing()
        self.fed.add("head_neck")
        self.assert_all_were_fed()

    def test_the_eyes_continue_when_the_neck_falls_silent(self):
        def write(name, header, elements, until):
            with open(self.path(name), "w") as file:
                for time in range(10**9, 10**9 + until, 10**7):
                    file.write("1 1 0 0 8 %d %s 1\n%s\n" % (time, header, elements))

        write("gaze.mtp", "20390 0 13 1", "0 0 0.1", 2 * 10**8)
        write("text.mtp", "60100 0 30 5", "HELLO", 10**9)
        self.shell(
            "hc simulator --clock messages --width 16 --height 16 --rate 20 --in gaze=gaze.mtp"
            " --in text=text.mtp --out left_pose=pose.mtp --out left=left.mtp"
        )
        times = [(each.time - 10**9) // 10**6 for each in read_messages(self.path("pose.mtp"))]
        # 0.1 s behind the last gaze, at 190, it waits for no other.
        self.assertEqual(times, [0, 50, 100, 150] + list(range(250, 1000, 50)))


if __name__ == "__main__":
    unittest.main()
