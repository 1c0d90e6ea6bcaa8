"""The same case gives the same bits, whatever the transport and the number of threads."""

import filecmp
import json
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import CONFIGS, KerfTest


class Bits(KerfTest):
    def assert_same_results(self, a, b):
        """Histories, frames and index byte by byte; the summary but for the wall time."""
        def files(folder):
            found = [p for part in ("history", "frames") for p in (folder / part).rglob("*")]
            return sorted(str(p.relative_to(folder)) for p in found + list(folder.glob("*.xdmf")))
        self.assertEqual(files(a), files(b))
        self.assertGreater(len(files(a)), 10)
        same, different, errors = filecmp.cmpfiles(a, b, files(a), shallow=False)
        self.assertEqual((different, errors), ([], []))
        summaries = [json.loads((f / "summary.json").read_text()) for f in (a, b)]
        for s in summaries:
            s.pop("wall_time", None)
        self.assertEqual(*summaries)

    def assert_case_is_deterministic(self, case, participants):
        case = CONFIGS / case
        def threads(n):
            return [x for p in participants for x in ("--set", f"participants.{p}.threads={n}")]
        base = self.run_case(case, *threads(1), out="shm-1")
        self.assert_same_results(base, self.run_case(case, *threads(2), out="shm-2"))
        self.assert_same_results(base, self.run_case(case, *threads(1), "--transport", "zmq",
                                                     out="zmq-1"))
        self.assert_same_results(base, self.run_case(case, *threads(2), "--transport", "zmq",
                                                     out="zmq-2"))

    def test_wave_bar_has_the_same_bits_over_shm_and_zmq_and_with_1_and_2_threads(self):
        self.assert_case_is_deterministic("wave_bar.toml", ["rock", "far", "whole"])

    def test_wave_block_has_the_same_bits_over_shm_and_zmq_and_with_1_and_2_threads(self):
        self.assert_case_is_deterministic("wave_block.toml", ["rock", "far", "whole"])


if __name__ == "__main__":
    unittest.main()
