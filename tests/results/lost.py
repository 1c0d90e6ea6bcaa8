"""What a user reads and finds when a body of elements can be computed no further."""

import math
import os
import re
import sys
import unittest

import h5py

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import KerfTest
from stretched import ELASTIC, LAMBDA, MU, SIDE

RHO, C11 = 2600.0, LAMBDA + 2 * MU
SPEED = 20.0  # m/s


def squeezed(case="", law="finite_strain = true"):
    """Two elements side by side of which the second is squeezed along x, at a constant speed."""
    return f"""[case]
name = "squeezed"
dimension = 2
end_time = {1.2 * SIDE / SPEED}
output = {{ frames = 3, history = 20 }}
{case}
[participants.body]
kind = "fem"
mesh = {{ origin = [0.0, 0.0], size = [{2 * SIDE}, {SIDE}], count = [2, 1] }}
material = {{ {ELASTIC}, {law} }}

[[participants.body.boundary]]
box = [[0.0, 0.0], [{SIDE}, {SIDE}]]
motion = "fixed"
[[participants.body.boundary]]
tag = "right"
motion = "velocity"
velocity = [{-SPEED}, 0.0]
"""


class Lost(KerfTest):
    def lose(self, text, pattern):
        """The numbers in the sentence that ends the run; the frames."""
        folder = self.folder / "run"
        result = self.kerf("run", self.write_case(text), "--out", folder)
        print(result.stderr.strip())
        self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
        self.assertRegex(result.stderr, pattern)
        frames = {}
        for path in sorted((folder / "frames").glob("body_*.h5")):
            with h5py.File(path) as file:
                frames[int(file["step"][0])] = (float(file["time"][0]), file["mesh/displacement"][:])
        return [float(x) for x in re.search(pattern, result.stderr).groups()], frames

    def test_an_element_that_turns_inside_out_ends_the_run_with_its_name_and_the_last_good_state(self):
        # Its length is SIDE - SPEED t: it is gone in the step after t = SIDE / SPEED
        step = 1.7e-6
        (t, n), frames = self.lose(
            squeezed(f"time_step = {step}\nallow_unstable = true\n"),
            r"element 1 has turned inside out, at t = (\S+) s \(step (\d+)\)")
        self.assertEqual(n, math.ceil(SIDE / SPEED / step))
        self.assertAlmostEqual(t, n * step, delta=1e-6 * t)
        last = max(frames)
        self.assertEqual(last, n - 1)
        self.assertAlmostEqual(frames[last][1][:, 0].min(), -SPEED * (n - 1) * step, delta=1e-9)

    def test_a_step_that_is_too_large_for_the_squeezed_body_ends_the_run(self):
        # The stiffest modes of a rectangle a by b of constant mass rho SIDE²:
        # omega² = 4 / (rho SIDE²) times the largest eigenvalue of
        # [[C11 b/a, C12], [C12, C11 a/b]]; 2 / omega = dt at the step that is named.
        (dt, critical, t, n), frames = self.lose(
            squeezed("time_step_factor = 0.6\n"),
            r"the time step of (\S+) s is above the critical one, which has fallen to (\S+) s with "
            r"element 1; give case\.time_step a smaller number or case\.time_step_factor more room, "
            r"at t = (\S+) s \(step (\d+)\)")
        a = (SIDE - SPEED * t) / SIDE
        mean, half = C11 * (a + 1 / a) / 2, C11 * (1 / a - a) / 2
        exact = 2 / math.sqrt(4 / (RHO * SIDE**2) * (mean + math.hypot(half, LAMBDA)))
        self.assertAlmostEqual(critical / exact, 1.0, delta=1e-4)
        self.assertLess(critical, dt)
        self.assertGreater(critical, 0.99 * dt)  # in the step before it was not
        self.assertEqual(max(frames), n - 1)

    def test_a_body_of_small_strain_does_not_notice(self):
        self.run_case(self.write_case(squeezed(law="finite_strain = false")))


if __name__ == "__main__":
    unittest.main()
