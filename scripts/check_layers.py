#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the direction of every #include: check_layers.py [ROOT]. Prints FILE:LINE: what is wrong."""

import collections
import pathlib
import re
import sys

# Library packages: over other libraries, without messages but in the files of MESSAGES.
PACKAGES = {"frames", "vision", "nets", "people", "graphics", "room", "sound", "gaze", "web"}
MESSAGES = {"messages", "module_cameras", "module_frames", "right_images"}
# A layer, and those that it may include beside itself.
ALLOWED = {
    "base": "",
    "os": "base",
    "mtp": "base",
    "contract": "base mtp",
    "compress": "base mtp contract",
    "testing": "",  # what tests share
    "link": "base os mtp",
    "client": "base os mtp contract link",
    "module": "base os mtp contract compress link",
    "graph": "base os mtp contract link",
    "frames": "base",
    "vision": "base os frames",
    "nets": "base",
    "people": "base nets vision",
    "gaze": "base",
    "graphics": "base compress",
    "room": "base graphics vision",
    "sound": "base os",
    "web": "base os mtp link client tls",
    "ros": "base mtp contract compress frames",
    "record": "base os mtp contract link ros",
    "tls": "base os link",
    "dds": "base os mtp link",
    "transports": "tls dds",
    "hosts": "base os mtp contract link graph tls",
    "drivers": "base os",
    "modules": "base os mtp contract compress module client ros record dds transports drivers "
    + " ".join(PACKAGES),
    "python": "base os mtp contract compress link client module frames record transports",
    "tools": "base os mtp contract compress link client graph frames record tls transports hosts",
}
ALLOWED = {layer: set(others.split()) for layer, others in ALLOWED.items()}
# How often a layer names what is internal to another, or to itself; these numbers may only fall, and no
# other layer does.
INTERNAL = {
    "dds": 26,
    "frames": 2,
    "python": 6,
    "ros": 6,
    "sound": 2,
    "tls": 8,
}
# Layers whose headers are not in hc/.
OUTSIDE = PACKAGES | {"client", "graph", "ros", "record", "tls", "transports", "hosts", "drivers"}
CORE = {"base", "os", "mtp", "contract", "compress", "link", "module", "client", "graph"}
# The mtp layer is pure: no input or output, no threads, no clock.
IMPURE = re.compile(
    r"<(sys/.*|unistd\.h|fcntl\.h|poll\.h|net.*|thread|mutex|atomic|condition_variable|future"
    r"|chrono|fstream|iostream|cstdio|filesystem)>"
)
# What a public header of the core may include beside ours: the standard library and Linux.
STANDARD = re.compile(r"<([a-z_]+|sys/[a-z]+\.h|unistd\.h|poll\.h|fcntl\.h)>")
INCLUDE = re.compile(r'^\s*#\s*include\s+([<"][^>"]+[>"])')
PRINTS = re.compile(r"std::c(out|err|log)\b|\b(printf|puts|fprintf)\s*\(")


def layer_of(path):
    """The layer that a file of the tree belongs to, by its folder."""
    parts = path.parts
    if parts[0] == "lib":
        return parts[2] if parts[1] == "hc" else parts[1]
    return parts[0]


def layer_of_include(name):
    inner = name[1:-1]
    if inner.startswith("dds/"):  # as Cyclone DDS has them too
        return "dds" if (pathlib.Path(__file__).parents[1] / "lib" / inner).exists() else None
    match = re.match(r"(hc/)?([a-z]+)/", inner)
    return match[2] if match and (match[1] or match[2] in OUTSIDE) else None


def problems(root):
    internal = collections.Counter()
    for path in sorted(root.glob("*/**/*")):
        if path.suffix not in (".h", ".cpp"):
            continue
        local = path.relative_to(root)
        if local.parts[0] not in ("lib", "drivers", "modules", "python", "tools"):
            continue
        layer = layer_of(local)
        is_test = path.stem.endswith("_test") or layer == "testing"
        is_messages = layer in PACKAGES and path.stem in MESSAGES
        allowed = ALLOWED.get(layer, set()) | ({"mtp", "module"} if is_messages else set())
        if layer not in CORE | {"testing"} and not is_test:
            internal[layer] += len(re.findall(r"\binternal::", path.read_text()))
        for number, line in enumerate(path.read_text().splitlines(), 1):
            where = "%s:%d: " % (local, number)
            if layer != "tools" and not is_test:
                if PRINTS.search(line.split("//")[0]):
                    yield where + "prints; standard output belongs to the links"
            match = INCLUDE.match(line)
            if not match:
                continue
            name, target = match[1], layer_of_include(match[1])
            if layer not in ALLOWED:
                yield where + "there is no layer " + layer
            elif target and target != layer and target not in allowed and not is_test:
                yield where + "%s may not include %s (%s)" % (layer, target, name)
            if layer == "modules" and ("modules/" in name or "../" in name):
                yield where + "a module includes no other module"
            if layer == "mtp" and not is_test and IMPURE.match(name):
                yield where + "the mtp layer is pure, so no " + name
            if layer in CORE and path.suffix == ".h" and not is_test and not target:
                if not STANDARD.match(name):
                    yield where + "a header of the core shows no other library (%s)" % name
    for layer, count in sorted(internal.items()):
        most = INTERNAL.get(layer, 0)
        if count > most:
            yield "%s: internal:: stands %d times, at most %d" % (layer, count, most)


if __name__ == "__main__":
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[1])
    found = list(problems(root))
    print("\n".join(found) if found else "layers: every include points the right way")
    sys.exit(1 if found else 0)
