# SPDX-License-Identifier: Apache-2.0
"""The table of tests/safety, and the worst that was measured for each of its limits."""

import json
import pathlib
import tomllib

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parents[1]


def rows():
    """The rows of table.toml, in its order."""
    return tomllib.loads((HERE / "table.toml").read_text())["row"]


def seen_file(build, name):
    """Where the worst of a row's limits is kept, by their names."""
    return pathlib.Path(build) / "tests/safety" / (name + ".json")


class Row:
    """A row while it is measured."""

    def __init__(self, name, build):
        self.row = next(row for row in rows() if row["name"] == name)
        self.limits = {limit["name"]: limit for limit in self.row["limits"]}
        self.worst, self.file = {}, seen_file(build, name)

    def note(self, limit, value, where="", excused=0):
        """Takes a measurement. "" where it is within its limit, else what happened, in one line. So
        much of it as is `excused` does not count, up to the limit itself."""
        self.worst[limit] = max(value, self.worst.get(limit, value))
        most, unit = self.limits[limit]["most"], self.limits[limit].get("unit", "")
        if value - min(excused, most) <= most:
            return ""
        text = "%s%s: %s: %s %s, at most %s"
        return text % (
            self.row["name"],
            where and " (%s)" % where,
            self.limits[limit]["text"],
            round(value, 3),
            unit,
            most,
        )

    def keep(self):
        self.file.parent.mkdir(parents=True, exist_ok=True)
        self.file.write_text(json.dumps(self.worst, indent=1) + "\n")
