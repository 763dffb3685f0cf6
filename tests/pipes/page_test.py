# SPDX-License-Identifier: Apache-2.0
"""The server of the page, as any client sees it: the graph's state, commands, streams."""

import json
import unittest

from graphs import GRAPH
from page import Page, message
from web_socket import BINARY, TEXT


class Graph(Page):
    def test_state_log_and_commands(self):
        process = self.serve()
        graph = self.socket("/graph", self.session())
        session = json.loads(self.hear(graph, 3, lambda text: '"bid"' in text))
        self.assertEqual(session["web"], "web")
        self.assertEqual(set(session["drives"]), {"bid", "stick"})
        self.assertIn("robot 2 world 0 0 1.2", session["frames"])
        state = json.loads(self.hear(graph, 1))
        self.assertIn("camera", [module["name"] for module in state["modules"]])
        answer = self.command(graph, "describe camera")
        self.assertEqual(json.loads(answer[1])["name"], "camera")
        self.assertIn("did you mean", self.command(graph, "describe camra")[0])
        self.assertEqual(self.command(graph, "set camera.rate=20"), ["ok"])
        self.hear(
            graph,
            1,
            lambda text: any(
                module["name"] == "camera" and module["parameters"].get("rate") == "20"
                for module in json.loads(text)["modules"]
            ),
        )
        self.assertIn("no parameter", self.command(graph, "set camera.rat=20")[0])
        self.assertEqual(self.command(graph, "restart brightness"), ["ok"])
        self.hear(
            graph,
            2,
            lambda text: json.loads(text)
            == {"module": "brightness", "level": "info", "text": "started"},
        )
        graph.send("stop")
        self.assertEqual(graph.code()[0], 1001)
        process.communicate()


class Streams(Page):
    def test_an_image_comes_as_it_is_wanted(self):
        process = self.serve()
        cookie = self.session()
        raw = self.socket("/streams/brightness.image", cookie)
        kind, header = raw.next()
        self.assertEqual((kind, header.split()[9:]), (TEXT, [b"80", b"60"]))
        header, elements = message(raw.next()[1])
        self.assertEqual((header[9:], len(elements)), ([80, 60], 80 * 60 * 3))
        jpeg = self.socket("/streams/camera.left?as=jpeg&width=40", cookie)
        self.assertEqual(jpeg.next()[1].split()[9:], [b"80", b"60"])
        header, elements = message(jpeg.next()[1])
        self.assertEqual((header[6], header[9:]), (30303, [40, 30]))
        self.assertEqual(elements.split(b"\n", 1)[1][:2], b"\xff\xd8")
        vp8 = self.socket("/streams/camera.left?as=vp8", cookie)
        vp8.next()
        for is_key in (True, False):
            kind, data = vp8.next()
            header, frame = message(data)
            self.assertEqual((header[6], header[10]), (120101, 1))
            self.assertEqual(not frame[0] & 1, is_key)
            vp8.send("ok")
        # Who missed images needs no key frame: the next one is coded after the last it was sent.
        for _ in range(20):
            self.assertIn(raw.next()[0], (TEXT, BINARY))
            raw.send("ok")
        sequences = [header[3]]
        for _ in range(3):
            kind, data = vp8.next()
            while kind == TEXT:
                kind, data = vp8.next()
            header, frame = message(data)
            self.assertTrue(frame[0] & 1)
            sequences.append(header[3])
            vp8.send("ok")
        self.assertGreater(max(b - a for a, b in zip(sequences, sequences[1:])), 2)
        table = self.socket("/streams/brightness.mean?as=jpeg&width=10", cookie)
        table.next()
        self.assertEqual(message(table.next()[1])[0][6], 120191)
        self.assertIn("did you mean", self.socket("/streams/camera.lef", cookie).code()[1])
        self.assertEqual(self.socket("/streams/camera.lef", cookie).code()[0], 4404)
        self.assertEqual(self.socket("/streams/camera.left?as=png", cookie).code()[0], 1008)
        self.stop(process)

    def test_who_does_not_answer_gets_two_and_then_the_newest(self):
        process = self.serve()
        cookie = self.session()
        stream = self.socket("/streams/brightness.mean", cookie)
        other = self.socket("/streams/brightness.mean", cookie)

        def sequence(socket):
            kind, data = socket.next()
            while kind == TEXT:
                kind, data = socket.next()
            self.assertEqual(kind, BINARY, data)
            return message(data)[0][3]

        first = [sequence(stream), sequence(stream)]
        for _ in range(50):  # meanwhile another gets on
            newest = sequence(other)
            other.send("ok")
        stream.send("ok")
        self.assertGreater(sequence(stream), newest - 3)
        self.assertLess(first[1], newest - 30)
        stream.send("rate=nonsense")
        self.assertEqual(stream.code()[0], 1008)
        self.stop(process)


class Any(Page):
    def test_any_graph_has_a_page(self):
        process = self.serve(GRAPH, "--page --quiet --set web.port=0")
        graph = self.socket("/graph", self.session())
        self.assertEqual(json.loads(self.hear(graph, 3))["stopped"], None)
        self.assertIn("no workspace", self.command(graph, "estop")[0])
        self.stop(process)

    def test_a_page_with_a_workspace_can_stop_it(self):
        workspace = GRAPH + '[workspace]\nmodule = "w"\n[modules.w]\nprogram = "workspace"\n'
        process = self.serve(workspace, "--page --set web.port=0")
        graph = self.socket("/graph", self.session())
        self.hear(graph, 3, lambda text: '"stopped":false' in text)
        self.order(graph, "estop")
        self.hear(graph, 3, lambda text: '"stopped":true' in text)
        self.stop(process)


if __name__ == "__main__":
    unittest.main(verbosity=2)
