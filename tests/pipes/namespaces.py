# SPDX-License-Identifier: Apache-2.0
"""Namespaces of a test's own, which not every machine permits."""

import os
import shlex
import subprocess
import sys

# Users other than root become it there; root stays it, also where that makes no such namespace, as
# in a chroot.
IS_ROOT = os.geteuid() == 0
UNSHARE = ["unshare", *([] if IS_ROOT else ["--map-root-user"])]
NSENTER = ["nsenter", *([] if IS_ROOT else ["--user", "--preserve-credentials"])]
INSIDE = "HC_TEST_NETWORK"


def move_to_own_network(setup="true"):
    """Starts this program again in a network of its own, which a line of shell prepares. Whether it
    is in one. To be called before anything takes arguments away."""
    if os.environ.pop(INSIDE, None):
        return True
    own = [*UNSHARE, "--net", "sh", "-c"]
    try:
        subprocess.run([*own, setup], stderr=-3, check=True)
    except (OSError, subprocess.CalledProcessError):
        return False
    again = setup + " && exec " + shlex.join([sys.executable, *sys.argv])
    os.execvpe(own[0], [*own, again], {**os.environ, INSIDE: "1"})
