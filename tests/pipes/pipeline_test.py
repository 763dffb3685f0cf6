#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The graph file `pipeline`: images that go through five modules, one after the other."""

import os
import re
import unittest

from harness import Pipes, ROOT


class Pipeline(Pipes):
    def run_pipeline(self, keep, *settings):
        self.environment["HC_KEEP"] = keep
        words = "".join(" --set " + setting for setting in settings)
        out = self.shell("hc run %s/graphs/pipeline.toml --links --quiet%s" % (ROOT, words))
        self.assertEqual(os.listdir(self.folder.name), [])
        return {
            link: int(count)
            for link, count in re.findall(r"^(\S+ → \S+) +(\d+) messages? ", out, re.M)
        }

    def test_every_pair_goes_through_where_none_is_to_be_dropped(self):
        links = self.run_pipeline("all", "camera.rate=0", "camera.count=12")
        for link in ("camera.left → rectify.left", "rectify.right → depth.right"):
            self.assertEqual(links[link], 12, links)
        self.assertEqual(links["depth.depth → augment.depth"], 12, links)
        self.assertEqual(links["augment.right → view.image"], 12, links)

    def test_a_slow_module_takes_the_newest_and_no_other_waits_for_it(self):
        settings = "depth.matcher=opencv", "camera.rate=40", "camera.count=40"
        links = self.run_pipeline("latest", *settings)
        self.assertGreater(
            links["camera.left → rectify.left"], links["depth.depth → augment.depth"]
        )
        self.assertLess(links["augment.left → view.image"], links["rectify.left → depth.left"])


if __name__ == "__main__":
    unittest.main()
