# SPDX-License-Identifier: Apache-2.0
"""What the scripts share that write documents and measure."""

import datetime
import difflib
import os
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]


def build_folder():
    """The folder of a build that is the first argument; without one, ends with what the script says
    of itself."""
    given = "".join(sys.argv[1:2])
    if not given or not pathlib.Path(given, "CMakeCache.txt").exists():
        print(sys.modules["__main__"].__doc__.strip(), file=sys.stderr)
        sys.exit(2)
    return pathlib.Path(given).resolve()


def machine():
    """The processor of this machine, its cores and today, in words."""
    name = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    name = " ".join(name[1].split()) if name else "this machine"
    return "%s, %d cores, %s" % (name, os.cpu_count(), datetime.date.today())


def hc_run(build, graph, settings=(), *options):
    """The command that runs a graph, of graphs/ where its path is not whole."""
    sets = [word for setting in settings for word in ("--set", setting)]
    return [build / "bin/hc", "run", ROOT / "graphs" / graph, *options, *sets]


def update(document, wanted, script, comparable=str):
    """Writes a document; with --check prints instead what differs of comparable(text), and returns
    whether something does."""
    path = ROOT / document
    if "--check" not in sys.argv[2:]:
        path.write_text(wanted)
        return False
    present, wanted = comparable(path.read_text()), comparable(wanted)
    before, after = present.splitlines(True), wanted.splitlines(True)
    sys.stdout.writelines(difflib.unified_diff(before, after, document, "made now"))
    if wanted != present:
        print("%s is not up to date: run scripts/%s build" % (document, script))
    return wanted != present
