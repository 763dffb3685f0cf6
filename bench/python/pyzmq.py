#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""pyzmq in the place of module.py: pyzmq.py ROLE COUNT BYTES ENDPOINT …"""

import struct
import sys
import time

import numpy
import zmq

role, count, size = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
depth = 4 if size > 10000 else 1000


def connect(kind, endpoint):
    link = zmq.Context.instance().socket(kind)
    link.set_hwm(depth)
    link.connect(endpoint)
    return link


source = connect(zmq.PULL, sys.argv[4])
if role == "invert":
    sink = connect(zmq.PUSH, sys.argv[5])
    while True:  # until it is killed
        frame = source.recv(copy=False)
        pixels = numpy.frombuffer(frame.buffer, numpy.uint8)
        out = numpy.empty_like(pixels)
        numpy.invert(pixels, out)
        out[:8] = pixels[:8]
        sink.send(out, copy=False)
elif role == "numbers":
    for i in range(1, count + 1):
        x, y, z = struct.unpack("3d", source.recv())
        if i == count // 10:
            begin = time.perf_counter()
    print((count - count // 10) / (time.perf_counter() - begin))
elif role == "handler":  # as a module calls one
    taken = 0

    def add(message):
        global taken, begin
        x, y, z = struct.unpack("3d", message)
        taken += 1
        if taken == count // 10:
            begin = time.perf_counter()

    while taken < count:
        add(source.recv())
    print((count - count // 10) / (time.perf_counter() - begin))
else:
    ways = []
    for _ in range(count):
        frame = source.recv(copy=False)
        now = time.time_ns()
        ways.append(now - struct.unpack_from("q", frame.buffer)[0])
    print(numpy.median(ways[count // 10 :]))
