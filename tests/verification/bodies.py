"""Boundaries, loads and rigid clusters of particles, as a user runs them: results, errors, the same bits."""

import csv
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import KerfTest

# A bar of a square lattice, held on the left, pulled on the right.
BAR = """[case]
name = "bar"
dimension = 2
end_time = 1e-3

[case.output]
frames = 2
history = 20

[participants.bar]
kind = "dem"
threads = 1
particles.lattice = { type = "square", spacing = 1e-3, origin = [0.0, 0.0], count = [12, 4] }
material = { density = 2600.0, normal_stiffness = 1e10, tangential_stiffness = 2e9 }
damping = { translation = 0.7, rotation = 0.7 }

[[participants.bar.boundary]]
box = [[-1e-4, -1.0], [1e-4, 1.0]]
components = ["x", "y", "rotation"]
motion = "fixed"

[[participants.bar.boundary]]
box = [[3.9e-3, -1.0], [4.1e-3, 1.0]]
components = ["y"]
motion = "velocity"
velocities = [[0.0, 0.0, 0.0], [1e-4, 0.0, 0.01], [2e-4, 0.0, 0.0]]

[[participants.bar.loads]]
box = [[10.9e-3, -1.0], [11.1e-3, 1.0]]
forces = [[0.0, 0.0, 0.0], [1e-4, 1e4, 0.0]]
distribution = "by_mass"

[[measures]]
name = "energy_balance_error"
expect = { max = 1e-3 }
"""


def rows(folder, name, **where):
    """Columns of a history by name, of the rows with the given values."""
    with open(folder / "history" / (name + ".csv")) as file:
        found = [row for row in csv.DictReader(line for line in file if not line.startswith("#"))
                 if all(float(row[key]) == value for key, value in where.items())]
    return {key: [float(row[key]) for row in found] for key in found[0]}


class Bodies(KerfTest):
    def assert_refused(self, case, old, new, *parts):
        self.assertIn(old, case)
        result = self.kerf("check", self.write_case(case.replace(old, new, 1)))
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        for part in parts:
            self.assertIn(part, result.stderr)


class Boundaries(Bodies):
    def test_reactions_carry_the_loads_and_the_books_have_the_work_of_both(self):
        run = self.run_case(self.write_case(BAR))
        wall, lifted = (rows(run, "bar_boundary", boundary=k) for k in (0, 1))
        load, bar = rows(run, "bar_loads", load=0), rows(run, "bar")
        self.assertAlmostEqual(wall["force_x"][-1], -1e4, delta=1.0)
        self.assertAlmostEqual(wall["force_y"][-1] + lifted["force_y"][-1], 0.0, delta=1.0)
        self.assertGreater(lifted["force_y"][-1], 10.0)  # it is bent upwards
        self.assertEqual(lifted["particles"][-1], 4)
        self.assertAlmostEqual(lifted["displacement_y"][-1], 1e-6, delta=1e-15)  # the integral of the table
        self.assertEqual(load["force_x"][-1], 1e4)
        for k in range(len(bar["time"])):
            work = wall["work"][k] + lifted["work"][k] + load["work"][k]
            self.assertAlmostEqual(bar["external_work"][k], work, delta=1e-12 * abs(work))

    def test_histories_have_the_same_bits_for_any_number_of_threads(self):
        case = self.write_case(BAR)
        one = self.run_case(case, out="one")
        two = self.run_case(case, "--set", "participants.bar.threads=2", out="two")
        for name in ("bar", "bar_boundary", "bar_loads"):
            self.assertEqual((one / "history" / (name + ".csv")).read_bytes(),
                             (two / "history" / (name + ".csv")).read_bytes())

    def test_what_cannot_be_is_refused_with_its_key(self):
        boundary, loads = "participants.bar.boundary", "participants.bar.loads[0]"
        self.assert_refused(BAR, "velocities =", "velocity = [0.0, 0.0]\nvelocities =", boundary + "[1].velocities",
                            "has both velocity and velocities")
        self.assert_refused(BAR, 'motion = "velocity"', 'motion = "fixed"', boundary + "[1].velocities",
                            "does not use it")
        self.assert_refused(BAR, 'motion = "fixed"', 'motion = "fixed"\nrotation = { axis = [0.0, 1.0], rate = 1.0 }',
                            boundary + "[0].rotation.axis", "turns in the plane")
        self.assert_refused(BAR, "forces =", "force = [1.0, 0.0]\nforces =", loads + ".forces", "has both")
        self.assert_refused(BAR, "forces = [[0.0, 0.0, 0.0], [1e-4, 1e4, 0.0]]\n", "", loads, "neither force nor forces")
        self.assert_refused(BAR, "box = [[10.9e-3", "box = [[10.99e-2", loads)  # upper below lower
        self.assert_refused(BAR, "[[10.9e-3, -1.0], [11.1e-3, 1.0]]", "[[0.5, -1.0], [0.6, 1.0]]",
                            "the box of load 0 holds no particle")
        self.assert_refused(BAR, '"by_mass"', '"evenly"', loads + ".distribution", "each", "by_mass")


if __name__ == "__main__":
    unittest.main()
