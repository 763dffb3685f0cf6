#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The module ros2 against peers of Cyclone DDS and Fast DDS that are not ours, both directions; and
against one that sends what is no message.

    ros2_test.py BUILD_FOLDER [TEST …]
"""

import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "pipes"))

from namespaces import move_to_own_network  # noqa: E402

# Peers of others use all interfaces, and the graph only loopback: here there is nothing else.
move_to_own_network("ip link set lo up")

from graphs import Graphs  # noqa: E402
from harness import ROOT, WATCHDOG  # noqa: E402

TYPES = {
    "Image": "sensor_msgs",
    "CompressedImage": "sensor_msgs",
    "PointCloud2": "sensor_msgs",
    "CameraInfo": "sensor_msgs",
    "JointState": "sensor_msgs",
    "PoseStamped": "geometry_msgs",
    "Twist": "geometry_msgs",
    "TFMessage": "tf2_msgs",
    "String": "std_msgs",
    "Float64MultiArray": "std_msgs",
}
# Everything that a peer sends becomes a message here, and is published again.
MIRROR = """
[frames.head]
parent = "robot"
moved_by = "second.pose"
[frames.camera]
parent = "head"
translation = [0.0, 0.0, 0.2]

[modules.first]
program = "ros2"
parameters.node = "first"
parameters.subscribe = '''/peer/Image=image coord=7,
/peer/CompressedImage:sensor_msgs/msg/CompressedImage=grey coord=7,
/peer/PointCloud2=points coord=3, /peer/CameraInfo=camera coord=9,
/peer/JointState=joints joints=tilt+pan, /peer/Twist=twist,
/peer/TFMessage:tf2_msgs/msg/TFMessage=pose child=base_link coord=2003, /peer/String=text,
/peer/Float64MultiArray=numbers'''
parameters.publish = '''first.image=/hc/Image,
first.grey=/hc/CompressedImage:sensor_msgs/msg/CompressedImage, first.points=/hc/PointCloud2,
first.camera=/hc/CameraInfo:sensor_msgs/msg/CameraInfo, first.joints=/hc/JointState joints=tilt+pan,
first.pose=/hc/PoseStamped, first.twist=/hc/Twist:geometry_msgs/msg/Twist, first.text=/hc/String,
first.numbers=/hc/Float64MultiArray, frames=/hc/TFMessage'''

[modules.second]
program = "ros2"
parameters.node = "second"
parameters.subscribe = "/peer/PoseStamped=pose coord=2003"
"""
# What ROS has a Cyclone of its own do where discovery is by this machine alone.
LOOPBACK = (
    '<General><AllowMulticast>false</AllowMulticast><Interfaces><NetworkInterface address="127.0.0.1"/>'
    "</Interfaces></General><Discovery><ParticipantIndex>auto</ParticipantIndex><Peers>"
    '<Peer address="127.0.0.1"/></Peers></Discovery>'
)
IDS = dict(int8=2, uint8=3, int16=4, uint16=5, int32=6, uint32=7, int64=8, uint64=9)
IDS.update(float32=10, float64=11, bool=15, byte=16, string=17)


def definitions():
    """Of lib/ros/schema.cpp: what messages are made of, by name."""
    source = (ROOT / "lib/ros/schema.cpp").read_text()
    source = source[source.index("kParts[]") : source.index("find_part")]
    string = r'"(?:[^"\\]|\\.)*"'
    found = re.findall(r"\{(%s),\s*((?:%s\s*)+)\}" % (string, string), source)
    join = lambda text: "".join(json.loads(each) for each in re.findall(string, text))
    return {join(name): join(text) for name, text in found}


def hash_of(name, all_definitions):
    """RIHS01 of a type, as rosidl_generator_type_description makes it."""
    parts = {}

    def whole(part):
        return part.replace("/", "/msg/")

    def describe(part):
        fields = []
        for line in all_definitions[part].splitlines():
            if "=" in line:
                continue  # a constant
            kind, field = line.split()[:2]
            array = re.match(r"(.*)\[(\d*)\]$", kind)
            kind = array[1] if array else kind
            size = int(array[2] or 0) if array else 0
            if kind not in IDS and whole(kind) not in parts:
                parts[whole(kind)] = None
                parts[whole(kind)] = describe(kind)
            of = {
                "type_id": IDS.get(kind, 1) + (48 if size else 144 if array else 0),
                "capacity": size,
                "string_capacity": 0,
                "nested_type_name": "" if kind in IDS else whole(kind),
            }
            fields.append({"name": field, "type": of})
        return {"type_name": whole(part), "fields": fields}

    described = {"type_description": describe(name)}
    described["referenced_type_descriptions"] = [parts[part] for part in sorted(parts)]
    return hashlib.sha256(json.dumps(described).encode()).hexdigest()


class Ros2(Graphs):
    def setUp(self):
        super().setUp()
        self.environment["ROS_DOMAIN_ID"] = str(os.getpid() % 100 + 1)
        self.environment["CYCLONEDDS_URI"] = LOOPBACK
        self.environment["FASTDDS_BUILTIN_TRANSPORTS"] = "UDPv4"

    def hear(self, process, wanted):
        """Reads lines of a process until there is one of each that is wanted."""
        lines = []
        while any(each not in lines for each in wanted):
            line = process.stdout.readline().decode().rstrip()
            missing = [each for each in wanted if each not in lines]
            self.assertTrue(line, "the peer has ended; missing: %s" % missing)
            self.assertNotIn(" wrong:", line)
            self.assertNotIn("not written", line)
            lines.append(line)
        return lines

    def check_peer(self, program, more=(), graph=None):
        if graph is None:
            self.write_graph(MIRROR)
            self.run_graph(last="second: started")
        peer = self.start("exec " + program, stdin=subprocess.PIPE)
        wanted = [name + " ok" for name in TYPES]
        wanted += ["node /first reads 9 writes 11", "node /second reads 1 writes 0"]
        lines = self.hear(peer, wanted + ["static head camera"] + list(more))
        peer.communicate(timeout=WATCHDOG)
        self.assertEqual(peer.returncode, 0)
        return lines

    def test_cyclone_dds_both_directions(self):
        known = definitions()
        publications = [
            "publication rt/hc/%s %s::msg::dds_::%s_ typehash=RIHS01_%s;"
            % (name, package, name, hash_of(package + "/" + name, known))
            for name, package in TYPES.items()
        ]
        self.check_peer("cyclone_peer", publications + ["participant enclave=/;"])

    def test_fast_dds_both_directions(self):
        self.check_peer("fast_peer")

    def test_what_is_no_message_is_refused(self):
        """In one line for each topic, counted, without much memory; what is one still comes."""
        graph = self.running_graph(MIRROR, last="second: started")
        hostile = self.start("exec hostile_peer", stdin=subprocess.PIPE)
        refused = {}
        while len(refused) < len(TYPES):
            line = self.await_lines(graph, ": ")[-1]
            found = re.match(r"(?:first|second): /peer/(\w+): message refused .*", line)
            if found:
                self.assertNotIn(found[1], refused, line)
                refused[found[1]] = line
        hostile.communicate(timeout=WATCHDOG)
        self.check_peer("cyclone_peer", graph=graph)
        children = pathlib.Path("/proc/%d/task/%d/children" % (graph.pid, graph.pid))
        for pid in children.read_text().split():
            status = pathlib.Path("/proc/%s/status" % pid).read_text()
            self.assertLess(int(re.search(r"VmHWM:\s+(\d+)", status)[1]), 300_000, status)
        _, err = self.stop(graph)
        for name in TYPES:
            self.assertRegex(err, r"\d+ refused of /peer/%s\b" % name)


if __name__ == "__main__":
    unittest.main()
