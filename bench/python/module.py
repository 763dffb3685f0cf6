#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The module in Python of scripts/bench_python: passes images on inverted, counts, or takes times."""

import time

import hypercolumn as hc
import numpy

module = hc.Module("python", "Passes images on inverted, counts numbers, or takes times.")
count = module.parameter("count", 1000, "", "messages")
image = module.input("image", hc.intensity_image(), "an image")
number = module.input("number", hc.table(), "numbers")
late = module.input("late", hc.intensity_image(), "an image whose way is measured")
made = module.output("made", hc.intensity_image(), "an image")
taken, begin, ways = 0, 0, []
first, last = 0, 0  # of the numbers that are measured


@module.on_start
def start():
    global first, last
    first, last = count.value // 10, count.value


@module.on(image)
def invert(message):
    with made.loan(message.height, message.width) as out:
        numpy.invert(message.matrix, out)


@module.on(number)
def add(message):
    global taken, begin
    x, y, z = message.numbers
    taken += 1
    if taken == first:
        begin = time.perf_counter()
    elif taken == last:
        module.log("%f" % ((last - first) / (time.perf_counter() - begin)), "result")


@module.on(late)
def look(message):
    now = time.time_ns()
    ways.append(now - message.time)


@module.on_end
def end():
    if ways:
        module.log("%f" % numpy.median(ways[len(ways) // 10 :]), "result")


module.run()
