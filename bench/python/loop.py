#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A loop over a link: loop.py URI COUNT prints the numbers' messages a second."""

import sys
import time

import hypercolumn as hc

last = int(sys.argv[2])
first, taken = last // 10, 0
for message in hc.open(sys.argv[1]):
    x, y, z = message.numbers
    taken += 1
    if taken == first:
        begin = time.perf_counter()
print((last - first) / (time.perf_counter() - begin))
