#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""check_skipped.py BUILD: lists the tests that the last ctest run skipped, and why.

Fails when there are more than `skipped_tests` in budgets.txt, or than $HC_MAX_SKIPPED.
"""

import os
import pathlib
import re
import sys

# unittest -v: "test_x (module.Class) ... skipped 'why'"; GoogleTest: "why" before "[  SKIPPED ] X.y".
UNITTEST = re.compile(r"^(test_\w+) .*\.\.\. skipped ['\"](.*)['\"]$", re.M)
GOOGLE = re.compile(r"^.*: Skipped\n(.*)\n(?:.*\n)*?\[  SKIPPED \] (\S+) \(", re.M)


def skipped(log):
    """Pairs of a skipped test's name and the reason that it gave."""
    pairs = [(name, why) for name, why in UNITTEST.findall(log)]
    return pairs + [(name, why) for why, name in GOOGLE.findall(log)]


def bound():
    if "HC_MAX_SKIPPED" in os.environ:
        return int(os.environ["HC_MAX_SKIPPED"])
    budgets = (pathlib.Path(__file__).parent / "budgets.txt").read_text()
    return int(re.search(r"^skipped_tests (\d+)$", budgets, re.M)[1])


if __name__ == "__main__":
    log = pathlib.Path(sys.argv[1], "Testing/Temporary/LastTest.log").read_text(errors="replace")
    found = skipped(log)
    for name, why in found:
        print("skipped: %s: %s" % (name, why))
    print("%d tests skipped, at most %d" % (len(found), bound()))
    sys.exit(1 if len(found) > bound() else 0)
