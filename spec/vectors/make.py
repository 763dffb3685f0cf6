#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the test vectors of MTP/1: the cases of valid_*.py and invalid_cases.py.

python3 make.py           write valid/ and invalid/
python3 make.py --check   tell whether the files are what this program writes
"""

import pathlib
import sys

sys.dont_write_bytecode = True

import cases  # noqa: E402
import invalid_cases  # noqa: E402,F401  takes down its cases
import valid_cases  # noqa: E402,F401
import valid_compressed  # noqa: E402,F401
import valid_numbers  # noqa: E402,F401

HERE = pathlib.Path(__file__).resolve().parent


def files():
    for folder, vectors in (("valid", cases.valid), ("invalid", cases.invalid)):
        for name, (data, result) in vectors.items():
            yield HERE / folder / (name + ".mtp"), data
            yield HERE / folder / (name + ".json"), result.encode()


def main():
    wanted = dict(files())
    present = set(HERE.glob("*valid/*"))
    if "--check" in sys.argv[1:]:
        wrong = [p for p, data in wanted.items() if p not in present or p.read_bytes() != data]
        wrong += sorted(present - set(wanted))
        for path in wrong:
            print("%s is not as make.py writes it" % path.relative_to(HERE))
        print("%d valid, %d invalid vectors" % (len(cases.valid), len(cases.invalid)))
        return 1 if wrong else 0
    for path in present - set(wanted):
        path.unlink()
    for path, data in wanted.items():
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(data)
    return 0


if __name__ == "__main__":
    sys.exit(main())
