"""Bodies of elements in stages: what changes, what goes on, and what ends a stage."""

import json
import os
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from restart import RestartTest, steps_of
from stages import end, table

# Ground under stress, in which a tunnel is dug; then its wall is loaded, and a ram comes down.
# Plastic flow, finite strain, and elements with hourglass control have more state than others.
TUNNEL = """
[case]
name = "tunnel"
dimension = 2
output = { frames = 5, history = 100000, checkpoints = 14, keep_checkpoints = 1000 }

[participants.rock]
kind = "fem"
threads = 1
mesh = { type = "tunnel", origin = [-10.0, -10.0], size = [20.0, 20.0], radius = 2.0, count = [5, 16], \
excavation = true }
in_situ_stress.stress = [-4e6, -8e6, -3e6, 0.0]
probes = [{ name = "crown", point = [0.0, 2.0] }, { name = "heart", point = [0.1, 0.1] }]
walls = [{ name = "ram", tag = "top", point = [0.0, 10.0], normal = [0.0, -1.0], \
velocities = [[0.0, 0.0], [0.03, 0.0], [0.04, 0.1]], friction = 0.2 }]
absorbing = [{ tag = "bottom" }]

[participants.rock.material]
model = "drucker_prager"
density = 2600.0
young_modulus = 2e9
poisson_ratio = 0.25
cohesion = 0.8e6
friction_angle = 30.0
finite_strain = true
formulation = "one_point"

[[participants.rock.boundary]]
tag = "left"
motion = "symmetry"
[[participants.rock.boundary]]
tag = "right"
motion = "symmetry"

[[stages]]
name = "rest"
duration = 0.02

[[stages]]
name = "dig"
duration = 0.1
stop = [{ name = "down", quantity = "displacement", probe = "crown", component = "y", below = -1.15e-2 }]
[[stages.changes]]
remove = ["excavation"]
reset_displacement = true
damping = { mass = 300.0 }

[[stages]]
name = "load"
duration = 0.03
[[stages.changes]]
participant = "rock"
gravity = [0.0, -9.81]
damping = { local = 0.1 }
loads = [{ tag = "wall", pressures = [[0.0, 0.0], [0.01, 2e6]] }]
"""


class Tunnel(RestartTest):
    def setUp(self):
        super().setUp()
        self.case = self.write_case(TUNNEL)
        self.whole = self.run_case(self.case, out="whole")
        self.rock, self.end = table(self.whole, "rock"), end(self.whole)
        print(self.end)

    def test_stages_follow_one_another_with_their_changes(self):
        rock, crown, heart = self.rock, table(self.whole, "rock_crown"), table(self.whole, "rock_heart")
        stage = rock["stage"]
        self.assertEqual([c["name"] for c in self.end["conditions"]], ["down"])
        self.assertEqual(sorted(set(stage)), [0, 1, 2])
        self.assertTrue((np.diff(rock["step"]) == 1).all())
        dug, loaded = (np.flatnonzero(stage == k)[0] for k in (1, 2))
        self.assertEqual(rock["step"][loaded], self.end["conditions"][0]["step"] + 1)
        self.assertEqual(self.end["conditions"][0]["value"], crown["displacement_y"][loaded - 1])

        # At rest before, but for rounding; then the crown of the tunnel comes down
        self.assertLess(np.abs(crown["displacement_y"][:dug]).max(), 1e-10)
        looked = (stage == 1) & (rock["step"] % 10 == 0)
        self.assertGreater(crown["displacement_y"][looked][:-1].min(), -1.15e-2)
        np.testing.assert_allclose(heart["stress_yy"][:dug], -8e6, rtol=1e-9)
        self.assertTrue(np.isnan(heart["stress_yy"][dug:]).all())  # which has been taken out
        loads = table(self.whole, "rock_loads")
        np.testing.assert_array_equal(loads["step"], rock["step"][loaded:])
        with h5py.File(sorted((self.whole / "frames").glob("rock_*.h5"))[-1]) as frame:
            inside = frame["mesh/mass"][:] == 0.0
        self.assertGreater(inside.sum(), 0)
        self.assertGreater(rock["plastic_dissipation"][-1], 0.0)
        ram = table(self.whole, "rock_ram")  # which holds what is under it
        np.testing.assert_allclose(ram["force_y"][1:dug], 8e6 * 20.0, rtol=1e-9)

    def test_a_restart_in_the_middle_of_any_stage_has_the_same_bits(self):
        begun = {0: 0, 1: int(self.rock["step"][self.rock["stage"] == 1][0]),
                 2: int(self.rock["step"][self.rock["stage"] == 2][0])}
        seen = set()
        for step in steps_of(self.whole)[:-1]:
            seen.add(max(k for k in begun if begun[k] < step))
            with self.subTest(step=step):
                again = self.folder / f"from_{step}"
                self.restart(self.case, f"{self.whole}@{step}", "--out", again)
                self.assert_same_results(self.whole, again)
        print("restarted in stages", seen)
        self.assertEqual(seen, {0, 1, 2})


# A strip of two regions, of which the right one is taken out while the left end moves and the top
# is pulled.
STRIP = """
[case]
name = "strip"
dimension = 2
output = { frames = 2, history = 100000 }

[participants.strip]
kind = "fem"
mesh = { type = "tunnel", origin = [-1.0, -1.0], size = [2.0, 2.0], radius = 0.3, count = [3, 16], \
excavation = true }
material = { density = 2600.0, young_modulus = 1e9, poisson_ratio = 0.2 }
probes = [{ name = "side", point = [1.0, 0.0] }]

[[participants.strip.boundary]]
tag = "left"
motion = "velocity"
velocities = [[0.0, 0.0, 0.0], [0.01, 0.1, 0.0]]
[[participants.strip.boundary]]
tag = "bottom"
components = ["y"]
motion = "displacement"
displacements = [[0.0, 0.0, 0.0], [0.01, 0.0, 1e-4]]
[[participants.strip.loads]]
tag = "top"
forces = [[0.0, 0.0, 0.0], [0.01, 0.0, 1e4]]

[[stages]]
name = "whole"
duration = 4e-3
[[stages]]
name = "dug"
duration = 4e-3
changes = [{ remove = ["excavation"] }]
[[stages]]
name = "other"
duration = 2e-3
[[stages.changes]]
loads = [{ tag = "top", tractions = [[0.0, 0.0, 0.0], [0.01, 1e5, 0.0]] }]
boundary = [{ tag = "left", motion = "velocity", velocity = [-0.2, 0.0] }]
"""


class Clocks(RestartTest):
    def test_tables_go_on_through_a_stage_that_does_not_change_them(self):
        run = self.run_case(self.write_case(STRIP))
        strip, boundary, loads = table(run, "strip"), table(run, "strip_boundary"), table(run, "strip_loads")
        begin = strip["time"][strip["stage"] == 2][0]
        of = lambda rows, what, k, name: rows[name][(rows[what] == k) & (rows["time"] < begin)]
        t = strip["time"][strip["time"] < begin]
        np.testing.assert_allclose(of(boundary, "boundary", 0, "displacement_x"), 5.0 * t**2,
                                   atol=1e-12)
        np.testing.assert_allclose(of(boundary, "boundary", 1, "displacement_y"), 1e-2 * t, atol=1e-15)
        np.testing.assert_allclose(of(loads, "load", 0, "force_y"), 1e6 * t, rtol=1e-12)

        after = loads["time"] >= begin  # other loads and motions count from there
        t = loads["time"][after] - begin
        np.testing.assert_allclose(loads["force_x"][after], 2.0 * 1e7 * t, rtol=1e-9, atol=1e-9)
        left = (boundary["boundary"] == 0) & (boundary["time"] >= begin)
        np.testing.assert_allclose(boundary["displacement_x"][left], 5.0 * begin**2 - 0.2 * t,
                                   atol=1e-12)
        self.assertEqual(((boundary["boundary"] == 1) & (boundary["time"] >= begin)).sum(), 0)

    def test_a_run_ends_by_a_probe_or_a_wall(self):
        pushed = STRIP[:STRIP.index("[[stages]]")].replace(
            "dimension = 2\n", 'dimension = 2\nend_time = 0.01\nstop = [STOP]\n') + """
[[participants.strip.walls]]
name = "ram"
tag = "right"
point = [1.0, 0.0]
normal = [-1.0, 0.0]
velocity = 0.5
"""
        for condition, file, column, sign in (
                ('quantity = "displacement", probe = "side", component = "x", below = -1e-3', "side",
                 "displacement_x", -1.0),
                ('quantity = "stress", probe = "side", component = "xx", below = -5e5', "side",
                 "stress_xx", -1.0),
                ('quantity = "force", wall = "ram", component = "x", above = 1e6', "ram", "force_x", 1.0)):
            with self.subTest(condition=condition):
                run = self.run_case(self.write_case(pushed.replace(
                    "STOP", f'{{ name = "c", every = 1, {condition} }}')))
                e, rows = end(run), table(run, "strip_" + file)
                self.assertEqual(e["by"], "c")
                bound = abs(float(condition.split()[-1]))
                self.assertEqual(e["conditions"][0]["value"], rows[column][-1])
                self.assertGreater(sign * rows[column][-1], bound)
                self.assertTrue((sign * rows[column][:-1] <= bound).all())

    def test_mistakes_are_named_before_the_run(self):
        for old, new, sentence in (
                ('remove = ["excavation"]', 'remove = ["excavaton"]',
                 r'stages\[1\]\.changes\[0\]\.remove: the mesh has no region "excavaton"; did you mean '
                 '"excavation"'),
                ('loads = [{ tag = "top"', 'loads = [{ tag = "tpo"',
                 r'stages\[2\]\.changes\[0\]\.loads\[0\]\.tag: the mesh has no tag "tpo"; did you mean "top"'),
                ('loads = [{ tag = "top", tractions', 'loads = [{ tag = "excavation", tractions',
                 r"stages\[2\]\.changes\[0\]\.loads\[0\]\.tag: traction and pressure need a tag of faces"),
                ('remove = ["excavation"]', 'bond_gap = 1e-3',
                 r"stages\[1\]\.changes\[0\]\.bond_gap is not a key of a change"),
                ("[0.01, 0.0, 1e-4]]", "[0.01, 0.0, 1e-4], [0.02]]", "rows of a time and 2 numbers"),
                ("displacements = [[0.0, 0.0, 0.0]", "displacements = [[0.0, 0.0, 1e-5]",
                 r"boundary\[1\]\.displacements: at t = 0 it is 1e-05 m along y; it must begin with zero"),
                ("point = [1.0, 0.0]", "point = [1.0, 2.0]",
                 r"probes\[0\]\.point: \(1, 2\) m is in no element")):
            with self.subTest(new=new):
                self.assertIn(old, STRIP)
                result = self.kerf("check", self.write_case(STRIP.replace(old, new)))
                self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
                self.assertRegex(result.stderr, sentence)


if __name__ == "__main__":
    unittest.main()
