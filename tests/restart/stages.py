"""Runs in stages, and what ends a run or a stage before its time."""

import json
import os
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from restart import RestartTest, steps_of

GRAINS = """
[case]
name = "grains"
dimension = 2
end_time = 4e-3
time_step = 1e-5
output = { frames = 4, history = 100000, checkpoints = 0 }

[participants.rock]
kind = "dem"
threads = 1
particles.lattice = { type = "square", spacing = 1.02e-3, origin = [0.0, 0.51e-3], count = [6, 4] }
particles.radius = 0.5e-3
bonds.kind = "none"
material = { density = 2600.0, normal_stiffness = 1e6, tangential_stiffness = 2e5, friction = 0.3, \
tensile_strength = 4.0, shear_strength = 4.0 }
damping = { translation = 0.5, rotation = 0.5 }
gravity = [0.0, -200.0]
# perfect columns would stand until rounding buckles them
initial = [{ kind = "velocity", box = [[-1e-3, 2e-3], [2.6e-3, 5e-3]], velocity = [0.02, 0.0] }]
probes = [{ name = "all", box = [[-1e-3, -1e-3], [7e-3, 6e-3]] }]

[[participants.rock.tools]]
name = "floor"
shape = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]
normal_stiffness = 1e6
tangential_stiffness = 2e5
friction = 0.3

[[participants.rock.tools]]
name = "press"
shape = "box"
box = [[-2e-3, 6e-3], [8e-3, 7e-3]]
normal_stiffness = 1e6
tangential_stiffness = 2e5
"""

STAGES = GRAINS.replace("end_time = 4e-3\n", "").replace("checkpoints = 0", "checkpoints = 300, "
                                                         "keep_checkpoints = 1000") + """
[[stages]]
name = "settle"
duration = 20e-3
stop = [{ name = "at_rest", quantity = "unbalanced_force", below = 1e-3, after = 1e-3 }]

[[stages]]
name = "press"
duration = 8e-3
stop = [{ name = "broken", quantity = "cracks", above = 3 }]
[[stages.changes]]
bond_gap = 3e-2
gravity = [0.0, -20.0]
friction = 0.6
damping = { translation = 0.2, rotation = 0.2 }
tools = [{ name = "press", velocity = [0.0, -1.0] }]

[[stages]]
name = "unload"
duration = 1e-3
[[stages.changes]]
participant = "rock"
tools = [{ name = "press", velocities = [[0.0, 0.0, -0.5], [5e-4, 0.0, 1.0]] }]
boundary = [{ box = [[-1e-3, 0.0], [1e-2, 1e-3]], motion = "fixed" }]
"""


def table(folder, name):
    with open(folder / "history" / f"{name}.csv") as file:
        file.readline()
        names = file.readline().strip().split(",")
        rows = np.loadtxt(file, delimiter=",", ndmin=2).reshape(-1, len(names))
    return dict(zip(names, rows.T))


def end(folder):
    return json.loads((folder / "summary.json").read_text())["end"]


class Stop(RestartTest):
    def run_until(self, condition, *arguments, text=GRAINS):
        case = self.write_case(text.replace("dimension = 2\n", "dimension = 2\nstop = [%s]\n" % condition))
        folder = self.run_case(case, *arguments)
        self.assertEqual(steps_of(folder), [])
        return folder, table(folder, "rock"), end(folder)

    def test_at_rest(self):
        folder, rock, e = self.run_until('{ name = "at_rest", quantity = "unbalanced_force", '
                                         'below = 1e-2, after = 1e-3, every = 7 }', "--set", "case.end_time=0.1")
        print(e)
        self.assertEqual(e["by"], "at_rest")
        last = int(rock["step"][-1])
        self.assertEqual(e["steps"], last + 1)
        self.assertEqual(last % 7, 0)
        looked = (rock["step"] % 7 == 0) & (rock["time"] >= 1e-3)
        self.assertTrue((rock["unbalanced_force"][looked][:-1] >= 1e-2).all())
        self.assertLess(rock["unbalanced_force"][-1], 1e-2)
        self.assertEqual(e["conditions"][0]["value"], rock["unbalanced_force"][-1])
        frames = sorted((folder / "frames").glob("rock_*.h5"))
        with h5py.File(frames[-1]) as frame:
            self.assertEqual(int(frame["step"][0]), last + 1)
        self.assertEqual(json.loads((folder / "run.json").read_text())["steps"], last + 1)

    def test_way_of_a_tool(self):
        step = 1e-6
        _, rock, e = self.run_until('{ name = "way", quantity = "displacement", tool = "press", '
                                    'component = "y", below = -1e-4, every = 1 }',
                                    "--set", "participants.rock.tools.press.velocity=[0.0, -0.5]",
                                    "--set", f"case.time_step={step}")
        # -0.5 n dt < -1e-4 first for n = 201 (n = 200 is -1e-4 but for round-off)
        self.assertEqual(e["by"], "way")
        self.assertIn(e["steps"] - 1, (200, 201))
        self.assertEqual(int(rock["step"][-1]), e["steps"] - 1)

    def test_force_and_strain_and_ratio(self):
        for condition, name in (('{ name = "c", quantity = "force", tool = "floor", component = "y", '
                                 'below = -0.5 }', "force"),
                                ('{ name = "c", quantity = "strain", probe = "all", '
                                 'component = "yy", below = -1e-3 }', "strain"),
                                ('{ name = "c", quantity = "stress", probe = "all", '
                                 'component = "yy", below = -20.0 }', "stress"),
                                ('{ name = "c", quantity = "kinetic_ratio", below = 0.5, '
                                 'after = 5e-4 }', "ratio")):
            with self.subTest(condition=condition):
                folder, rock, e = self.run_until(condition, "--set", "case.end_time=0.05")
                self.assertEqual(e["by"], "c")
                value = e["conditions"][0]["value"]
                last = {"force": table(folder, "rock_floor")["force_y"],
                        "strain": table(folder, "rock_all")["strain_yy"],
                        "stress": table(folder, "rock_all")["stress_yy"],
                        "ratio": rock["kinetic_ratio"]}[name]
                print(name, value, e["steps"])
                self.assertEqual(value, last[-1])

    def test_a_condition_that_is_not_met_lets_the_run_end_in_time(self):
        _, rock, e = self.run_until('{ name = "never", quantity = "cracks", above = 5 }')
        self.assertEqual((e["by"], e["conditions"]), ("time", []))
        self.assertAlmostEqual(e["value"], 4e-3, delta=1e-12)

    def test_a_restart_ends_by_the_same_condition(self):
        case = self.write_case(GRAINS.replace("dimension = 2\n", 'dimension = 2\nstop = [{ name = '
                               '"at_rest", quantity = "unbalanced_force", below = 1e-2, '
                               'after = 1e-3 }]\n'))
        more = ("--set", "case.output.checkpoints=30", "--set", "case.output.keep_checkpoints=50",
                "--set", "case.end_time=0.02")
        whole = self.run_case(case, *more, out="whole")
        again = self.folder / "again"
        self.restart(case, f"{whole}@{steps_of(whole)[1]}", "--out", again, *more)
        self.assert_same_results(whole, again)

    def refusal(self, text):
        result = self.kerf("run", self.write_case(text), "--out", self.folder / "refused")
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        print(result.stderr.strip())
        return result.stderr

    def test_mistakes_are_named(self):
        def with_stop(text):
            return GRAINS.replace("dimension = 2\n", "dimension = 2\nstop = [%s]\n" % text)
        for text, sentence in (
                ('{ name = "a", quantity = "cracks" }', r"case\.stop\[0\] has no bound"),
                ('{ name = "a", quantity = "cracks", above = 1, below = 2 }', "more than one bound"),
                ('{ name = "a", quantity = "crakcs", above = 1 }', "did you mean cracks"),
                ('{ name = "a", quantity = "strain", component = "xx", above = 1 }',
                 r"case\.stop\[0\]\.probe is missing"),
                ('{ name = "a", quantity = "strain", probe = "al", component = "xx", above = 1 }',
                 "did you mean all"),
                ('{ name = "a", quantity = "force", tool = "floor", component = "xx", above = 1 }',
                 r'component = "xx" is none of'),
                ('{ name = "a", quantity = "cracks", tool = "floor", above = 1 }',
                 r"tool is given"),
                ('{ name = "a", quantity = "cracks", participant = "rok", above = 1 }',
                 "did you mean rock"),
                ('{ name = "a", quantity = "cracks", above = 1 }, { name = "a", quantity = '
                 '"cracks", above = 2 }', "two conditions are named")):
            with self.subTest(text=text):
                self.assertRegex(self.refusal(with_stop(text)), sentence)
        self.assertRegex(self.refusal(GRAINS.replace("end_time = 4e-3\n", "")),
                         r"case\.end_time is missing")
        self.assertRegex(self.refusal(STAGES.replace('name = "press", velocity', 'name = "pres", velocity')),
                         "did you mean press")
        two = GRAINS.replace("dimension = 2\n", 'dimension = 2\nstop = [{ name = "a", participant = '
                             '"rock", quantity = "cracks", above = 1 }]\n') + """
[participants.more]
kind = "fem"
mesh = { origin = [1.0, 0.0], size = [1e-2, 1e-2], count = [2, 2] }
material = { density = 2000.0, young_modulus = 1e10, poisson_ratio = 0.0 }
"""
        self.assertRegex(self.refusal(two), r"case\.stop: the case has 2 participants")


class Stages(RestartTest):
    def setUp(self):
        super().setUp()
        self.case = self.write_case(STAGES)
        self.whole = self.run_case(self.case, out="whole")
        self.rock, self.press = table(self.whole, "rock"), table(self.whole, "rock_press")
        self.end = end(self.whole)
        print(self.end)

    def test_follow_one_another_and_say_which_one_it_is(self):
        rock, press = self.rock, self.press
        self.assertEqual([c["name"] for c in self.end["conditions"]], ["at_rest", "broken"])
        self.assertEqual([c["stage"] for c in self.end["conditions"]], ["settle", "press"])
        self.assertEqual(self.end["by"], "time")
        self.assertEqual(sorted(set(rock["stage"])), [0, 1, 2])
        self.assertTrue((np.diff(rock["stage"]) >= 0).all())
        self.assertTrue((np.diff(rock["step"]) == 1).all())  # time goes on
        settled, broken = (c["step"] for c in self.end["conditions"])
        self.assertEqual(rock["step"][rock["stage"] == 1][0], settled + 1)
        self.assertEqual(rock["step"][rock["stage"] == 2][0], broken + 1)

        # bonded now, of grains that were loose
        self.assertEqual(rock["bonds"][rock["stage"] == 0].max(), 0)
        self.assertGreater(rock["bonds"][rock["stage"] == 1][0], 20)
        self.assertGreater(rock["broken_bonds"][rock["stage"] == 1][-1], 3)
        self.assertLess(rock["fragments"][rock["stage"] == 1][0], 24)

        # the press rests, comes down, and then follows its table from the stage's beginning
        y, stage, t = press["position_y"], rock["stage"], rock["time"]
        self.assertEqual(np.ptp(y[stage == 0]), 0.0)
        begin = t[stage == 1][0]
        np.testing.assert_allclose(y[stage == 1] - y[0], -(t[stage == 1] - begin), atol=1e-15)
        last = t[stage == 2] - t[stage == 2][0]
        way = np.where(last < 5e-4, -0.5 * last + 1.5 / 5e-4 * last**2 / 2,
                       -0.25e-3 + 0.375e-3 + (last - 5e-4))
        np.testing.assert_allclose(y[stage == 2] - y[stage == 2][0], way, atol=1e-12)

    def test_bonding_makes_no_jump_of_force(self):
        rock = self.rock
        first = np.flatnonzero(rock["stage"] == 1)[0]
        before, after = rock["elastic_energy"][first - 1], rock["elastic_energy"][first]
        print(f"elastic energy {before:.6g} J before bonding, {after:.6g} J after it")
        self.assertAlmostEqual(after / before, 1.0, delta=1e-2)

    def test_the_books_stay_closed(self):
        r = self.rock
        stored = r["kinetic_energy"] + r["elastic_energy"]
        lost = r["damping_dissipation"] + r["friction_dissipation"] + r["fracture_dissipation"]
        error = np.abs(stored - stored[0] - (r["external_work"] - r["external_work"][0]) + lost - lost[0])
        scale = np.abs(r["external_work"]).max()
        print(f"energy is missed by {error.max() / scale:.2g} of the work")
        self.assertLess(error.max() / scale, 2e-2)

    def test_a_restart_in_the_middle_of_any_stage_has_the_same_bits(self):
        begun = {0: 0}
        for c, k in zip(self.end["conditions"], (1, 2)):
            begun[k] = c["step"] + 1
        seen = set()
        for step in steps_of(self.whole)[:-1]:
            seen.add(max(k for k in begun if begun[k] < step))
            with self.subTest(step=step):
                again = self.folder / f"from_{step}"
                self.restart(self.case, f"{self.whole}@{step}", "--out", again)
                self.assert_same_results(self.whole, again)
        print("restarted in stages", seen)
        self.assertEqual(seen, {0, 1, 2})


if __name__ == "__main__":
    unittest.main()
