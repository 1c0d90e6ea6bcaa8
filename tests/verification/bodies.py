"""Boundaries, loads and rigid clusters of particles, as a user runs them: results, errors, the same bits."""

import csv
import json
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
end_time = 5e-3

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
        self.assert_refused(BAR, "velocities =", "velocity = [0.0, 0.0]\nvelocities =", boundary + "[1] has both velocity and velocities")
        self.assert_refused(BAR, 'motion = "velocity"', 'motion = "fixed"', boundary + "[1].velocities",
                            "does not use it")
        self.assert_refused(BAR, 'motion = "fixed"', 'motion = "fixed"\nrotation = { axis = [0.0, 1.0], rate = 1.0 }',
                            boundary + "[0].rotation.axis", "turns in the plane")
        self.assert_refused(BAR, "forces =", "force = [1.0, 0.0]\nforces =", loads + " has both force and forces")
        self.assert_refused(BAR, "forces = [[0.0, 0.0, 0.0], [1e-4, 1e4, 0.0]]\n", "", loads, "neither force nor forces")
        self.assert_refused(BAR, "box = [[10.9e-3", "box = [[10.99e-2", loads)  # upper below lower
        self.assert_refused(BAR, "[[10.9e-3, -1.0], [11.1e-3, 1.0]]", "[[0.5, -1.0], [0.6, 1.0]]",
                            "the box of load 0 holds no particle")
        self.assert_refused(BAR, '"by_mass"', '"evenly"', loads + ".distribution", "each", "by_mass")


# Three clumps on a floor and a wheel of four particles that turns as told and kicks them.
CLUMPS = """[case]
name = "clumps"
dimension = 2
end_time = 2e-3

[case.output]
frames = 2
history = 20

[participants.clumps]
kind = "dem"
threads = 1
particles.file = "clumps.txt"
material = { density = 2600.0, normal_stiffness = 1e7, tangential_stiffness = 2e6, friction = 0.4 }
bonds = { kind = "none" }
damping = { kind = "componentwise", translation = 0.1, rotation = 0.1 }
gravity = [0.0, -9.81]

[[participants.clumps.clusters]]
file = "clumps.txt"

[[participants.clumps.clusters]]
box = [[-3.1e-3, 0.0], [-1.5e-3, 3.1e-3]]
motion = "prescribed"
velocity = [0.2, 0.0]
rotation = { rates = [[0.0, 0.0], [1e-3, 100.0]] }

[[participants.clumps.tools]]
name = "floor"
shape = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]
normal_stiffness = 1e7
tangential_stiffness = 2e6
friction = 0.4

[[measures]]
name = "energy_balance_error"
expect = { max = 0.05 }
"""
# x y r and the body, as YADE writes clumps; -1: a particle of its own.
PLACES = """#format x_y_z_r_clump
-3e-3 1e-3 0 0.5e-3 -1
-2e-3 1e-3 0 0.5e-3 -1
-3e-3 2e-3 0 0.5e-3 -1
-2e-3 2e-3 0 0.5e-3 -1
0 0.5e-3 0 0.5e-3 0
0.8e-3 0.5e-3 0 0.5e-3 0
0.4e-3 1.2e-3 0 0.5e-3 0
2e-3 0.5e-3 0 0.5e-3 7
2.9e-3 0.5e-3 0 0.5e-3 7
4e-3 0.5e-3 0 0.5e-3 -1
"""


class Clusters(Bodies):
    def setUp(self):
        super().setUp()
        (self.folder / "clumps.txt").write_text(PLACES)

    def test_bodies_move_as_one_and_have_a_history(self):
        run = self.run_case(self.write_case(CLUMPS))
        first, second, wheel = (rows(run, "clumps_clusters", cluster=k) for k in range(3))
        self.assertEqual([body["particles"][-1] for body in (first, second, wheel)], [3, 2, 4])
        t = wheel["time"][-1]
        self.assertAlmostEqual(wheel["position_x"][-1], -2.5e-3 + 0.2 * t, delta=1e-12)
        self.assertAlmostEqual(wheel["angular_velocity_z"][-1], 100.0, delta=1e-6)
        self.assertLess(second["position_y"][-1], 0.51e-3)  # it lies on the floor
        import h5py
        frames = sorted((run / "frames").glob("clumps_*.h5"))
        with h5py.File(frames[0]) as start, h5py.File(frames[-1]) as end:
            cluster = end["particles/cluster"][:].ravel()
            before, after = start["particles/position"][:], end["particles/position"][:]
        self.assertEqual(list(cluster), [2, 2, 2, 2, 0, 0, 0, 1, 1, -1])
        for i in range(10):
            for j in range(i):
                if cluster[i] == cluster[j]:
                    apart = [math.dist(x[i], x[j]) for x in (before, after)]
                    self.assertAlmostEqual(apart[0], apart[1], delta=1e-15)

    def test_histories_have_the_same_bits_for_any_number_of_threads(self):
        case = self.write_case(CLUMPS)
        one = self.run_case(case, out="one")
        two = self.run_case(case, "--set", "participants.clumps.threads=2", out="two")
        for name in ("clumps", "clumps_clusters", "clumps_floor"):
            self.assertEqual((one / "history" / (name + ".csv")).read_bytes(),
                             (two / "history" / (name + ".csv")).read_bytes())

    def test_what_cannot_be_is_refused_with_its_key(self):
        key = "participants.clumps.clusters"
        self.assert_refused(CLUMPS, 'file = "clumps.txt"\n\n[[participants.clumps.clusters]]\nbox',
                            'file = "clumps.txt"\nbox = [[0.0, 0.0], [1.0, 1.0]]\n\n[[participants.clumps.clusters]]\nbox',
                            key + "[0]", "box and file")
        self.assert_refused(CLUMPS, 'motion = "prescribed"', "velocities = [[0.0, 0.0, 0.0]]", key + "[1].velocities")
        self.assert_refused(CLUMPS, 'motion = "prescribed"', 'motion = "prescribed"\nmass = 2.0', key + "[1].mass")
        self.assert_refused(CLUMPS, "box = [[-3.1e-3, 0.0], [-1.5e-3, 3.1e-3]]", "ids = [4, 0]", "is in clusters[0]")
        self.assert_refused(CLUMPS, "box = [[-3.1e-3, 0.0], [-1.5e-3, 3.1e-3]]", "ids = [77]", "there is no particle 77")
        (self.folder / "short.txt").write_text("0\n0\n")
        self.assert_refused(CLUMPS, '[[participants.clumps.clusters]]\nfile = "clumps.txt"',
                            '[[participants.clumps.clusters]]\nfile = "short.txt"', key + "[0].file",
                            "2 lines for 10 particles")


class MassScaling(Bodies):
    SCALED = BAR.replace("[[participants.bar.boundary]]", "[participants.bar.mass_scaling]\ncritical_step = 1e-6\n\n"
                         "[[participants.bar.boundary]]", 1)

    def test_lengthens_the_step_and_says_how_much_it_added(self):
        import json
        run = self.run_case(self.write_case(self.SCALED))
        about = json.loads((run / "run.json").read_text())
        self.assertAlmostEqual(about["time_step"], 0.8e-6, delta=0.01e-6)
        log = (run / "logs" / "bar.log").read_text()
        self.assertIn("mass scaling:", log)
        self.assertIn("of 48 particles are heavier", log)
        self.assertIn("mass_scaling", json.dumps(about))
        self.assertAlmostEqual(rows(run, "bar_boundary", boundary=0)["force_x"][-1], -1e4, delta=10.0)

    def test_is_refused_where_waves_count(self):
        key = "participants.bar.mass_scaling"
        self.assert_refused(self.SCALED, 'motion = "fixed"', 'motion = "hann"\namplitude = [1e-6, 0.0]\nduration = 1e-5',
                            key, "makes a wave")
        self.assert_refused(self.SCALED, "critical_step = 1e-6", "critical_step = 1e-6\nfactor = 2.0", key, "either")
        self.assert_refused(self.SCALED, "critical_step = 1e-6", "factor = 0.5", key + ".factor")


# A random packing whose outer particles are held, under stress from the start; a part of them is let go.
STRESSED = """[case]
name = "stressed"
dimension = 2
time_step_factor = 0.7 # what is let go may have the highest frequency

[case.output]
frames = 1
history = 20

[participants.rock]
kind = "dem"
threads = 1
material = { density = 2600.0, normal_stiffness = 1.6e10, tangential_stiffness = 3.2e9 }
bonds = { coordination_number = 5.4 }
damping = { kind = "componentwise", translation = 0.5, rotation = 0.5 }
in_situ_stress.stress = [-5e6, -10e6, 1e6]

[participants.rock.particles.packing]
region.box = [[0.0, 0.0], [0.05, 0.05]]
radii = { law = "uniform", min = 0.5e-3, max = 0.8e-3 }
porosity = 0.15

[[participants.rock.boundary]]
box = [[-1.0, -1.0], [2e-3, 1.0]]
motion = "fixed"

[[participants.rock.boundary]]
box = [[48e-3, -1.0], [1.0, 1.0]]
motion = "fixed"

[[participants.rock.boundary]]
box = [[-1.0, -1.0], [1.0, 2e-3]]
motion = "fixed"

[[participants.rock.boundary]]
box = [[-1.0, 48e-3], [1.0, 1.0]]
motion = "fixed"

[[participants.rock.probes]]
name = "middle"
box = [[3e-3, 3e-3], [47e-3, 47e-3]]

[[stages]]
name = "rest"
duration = 1e-4

[[stages]]
name = "open_top"
duration = 1e-3
stop = [{ name = "at_rest", quantity = "unbalanced_force", below = 1e-4, after = 2e-4 }]
[[stages.changes]]
boundary = [{ box = [[-1.0, -1.0], [2e-3, 1.0]], components = ["x", "rotation"], motion = "fixed" },
            { box = [[48e-3, -1.0], [1.0, 1.0]], components = ["x", "rotation"], motion = "fixed" },
            { box = [[-1.0, -1.0], [1.0, 2e-3]], components = ["y", "rotation"], motion = "fixed" }]
"""


class InSituStress(Bodies):
    def test_is_what_a_probe_reads_until_something_is_let_go(self):
        run = self.run_case(self.write_case(STRESSED))
        probe, rock = rows(run, "rock_middle"), rows(run, "rock")
        last = max(k for k, stage in enumerate(rock["stage"]) if stage == 0)
        self.assertGreater(last, 0)
        wanted = (-5e6, -10e6, 1e6)
        for k in (0, last):
            read = [probe["stress_" + c][k] for c in ("xx", "yy", "xy")]
            self.verify("stress that a probe reads in a random packing, over the largest component",
                        "the stress that was prescribed", max(abs(a - b) for a, b in zip(read, wanted)) / 10e6, 0.03,
                        "the box cuts contacts at its edge, 70 particles long")
            self.assertLess(rock["unbalanced_force"][k], 1e-8)
        self.assertLess(rock["kinetic_energy"][last], 1e-12 * rock["elastic_energy"][last])
        about = json.loads((run / "run.json").read_text())["participants"]["rock"]
        stress = json.dumps(about)
        self.assertIn("in_situ_stress", stress)
        self.assertIn("in-situ stress: the mean is", (run / "logs" / "rock.log").read_text())
        # Without the top nothing carries the vertical stress. It rests again.
        self.assertEqual(json.loads((run / "summary.json").read_text())["end"]["by"], "at_rest")
        self.assertLess(abs(probe["stress_yy"][-1]), 0.02 * 10e6)
        self.assertGreater(probe["strain_yy"][-1], 1e-5)
        self.assertEqual(rock["bonds"][-1], rock["bonds"][0])

    def test_that_nothing_carries_is_refused(self):
        key = "participants.rock.in_situ_stress"
        stress = "in_situ_stress.stress = [-5e6, -10e6, 1e6]"
        self.assert_refused(STRESSED, stress, "in_situ_stress.stress = [-5e6, -10e6]", key, "2 numbers", "xx yy xy")
        self.assert_refused(STRESSED, stress, "in_situ_stress = { K0 = 0.5, surface = 1.0 }", key, "no gravity")
        self.assert_refused(STRESSED, stress, "gravity = [0.0, -9.81]\nin_situ_stress.K0 = 0.5", key + ".surface")
        self.assert_refused(STRESSED, stress, stress + "\nin_situ_stress.K0 = 0.5", key, "either stress or K0")
        self.assert_refused(STRESSED, "bonds = { coordination_number = 5.4 }", 'bonds.kind = "none"', key, "no bonds")
        self.assert_refused(STRESSED, "density = 2600.0", "tensile_strength = 1.0, shear_strength = 1.0, density = 2600.0",
                            key, "the bond of particles", "its strength is 1 N")


# Discs that fall on one another.
GRAINS = """[case]
name = "grains"
dimension = 2
end_time = 4e-3

[participants.grains]
kind = "dem"
threads = 1
particles.lattice = { type = "square", spacing = 1e-3, origin = [0.0, 2e-3], count = [6, 8] }
particles.radius = 0.45e-3
material = { density = 2600.0, normal_stiffness = 1e8, tangential_stiffness = 2e7, friction = 0.3 }
bonds.kind = "none"
gravity = [3.0, -9.81e2]

[[participants.grains.tools]]
name = "floor"
shape = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]
normal_stiffness = 1e8
tangential_stiffness = 2e7
"""


class Grains(Bodies):
    def test_that_do_not_touch_yet_have_a_time_step(self):
        case = self.write_case(GRAINS)
        plan = self.kerf("check", case)
        self.assertEqual(plan.returncode, 0, plan.stderr)
        self.assertRegex(plan.stdout, r"that contacts to come of particle \d+ of grains sets")
        run = self.run_case(case)  # the step holds when they do
        grains = rows(run, "grains")
        self.assertGreater(max(grains["elastic_energy"]), 0.0)
        # Contacts last a few steps at 0.8 of the critical one: an impact at omega dt = 0.4 already misses 3 %.
        self.assertLess(max(abs(k + e - w + f) for k, e, w, f in zip(
            grains["kinetic_energy"], grains["elastic_energy"], grains["external_work"],
            grains["friction_dissipation"])), 0.1 * max(grains["external_work"]))

    def test_may_be_given_a_larger_step_until_they_touch(self):
        step = json.loads((self.run_case(self.write_case(GRAINS)) / "run.json").read_text())["critical_time_step"]
        result = self.kerf("run", self.write_case(GRAINS.replace("end_time", f"time_step = {1.2 * step}\nend_time")))
        self.assertEqual(result.returncode, 0, result.stderr)


# A bonded block in a box; the particles above it are loose spheres of another material.
ROCK_AND_GRAINS = """[case]
name = "grains"
dimension = 3
end_time = 2e-5

[case.output]
frames = 2
history = 10

[participants.grains]
kind = "dem"
threads = 1
gravity = [0.0, 0.0, -9.81]
particles.lattice = { type = "cubic", spacing = 1e-3, origin = [0.0, 0.0, 0.0], count = [4, 4, 6] }

[participants.grains.material]
name = "rock"
density = 2600.0
normal_stiffness = 1e7
tangential_stiffness = 2e6
tensile_strength = 0.5
shear_strength = 0.5

[[participants.grains.materials]]
name = "glass"
box = [[-1.0, -1.0, 2.5e-3], [1.0, 1.0, 1.0]]
density = 1500.0
law = "hertz_mindlin"
young_modulus = 2e9
poisson_ratio = 0.25
friction = 0.3

[[participants.grains.pairs]]
between = ["rock", "glass"]
law = "hertz_mindlin"
young_modulus = 5e9
poisson_ratio = 0.2
friction = 0.4

[[participants.grains.initial]]
box = [[-1.0, -1.0, 2.5e-3], [1.0, 1.0, 1.0]]
kind = "velocity"
velocity = [0.0, 0.1, -2.0]
"""


class Materials(Bodies):
    def test_rock_and_grains_have_their_masses_laws_and_bonds(self):
        import h5py
        run = self.run_case(self.write_case(ROCK_AND_GRAINS))
        with h5py.File(sorted((run / "frames").glob("grains_*.h5"))[-1]) as frame:
            material = frame["particles/material"][:].ravel()
            mass = frame["particles/mass"][:].ravel()
            z = frame["particles/position"][:, 2]
        self.assertEqual(sorted(set(material)), [0, 1])
        volume = math.pi / 6.0 * 1e-9
        for k in range(len(mass)):
            self.assertAlmostEqual(mass[k], (2600.0, 1500.0)[material[k]] * volume, delta=1e-20)
        self.assertLess(max(z[material == 0]), max(z[material == 1]))
        bonds = self.run_case(self.write_case(ROCK_AND_GRAINS), "--set", "case.end_time=1e-7", out="short")
        with h5py.File(sorted((bonds / "frames").glob("grains_*.h5"))[0]) as frame:
            self.assertEqual(int(frame["contacts/bonded"][:].sum()), 3 * 24 + 2 * 16)  # of 4 x 4 x 3

    def test_histories_have_the_same_bits_for_any_number_of_threads(self):
        case = self.write_case(ROCK_AND_GRAINS)
        one = self.run_case(case, out="one")
        two = self.run_case(case, "--set", "participants.grains.threads=2", out="two")
        name = "grains.csv"
        self.assertEqual((one / "history" / name).read_bytes(), (two / "history" / name).read_bytes())

    def test_what_cannot_be_is_refused_with_its_key(self):
        key = "participants.grains."
        self.assert_refused(ROCK_AND_GRAINS, 'between = ["rock", "glass"]', 'between = ["rock", "gless"]',
                            key + "pairs[0].between", "did you mean glass")
        self.assert_refused(ROCK_AND_GRAINS, "box = [[-1.0, -1.0, 2.5e-3], [1.0, 1.0, 1.0]]\ndensity",
                            "box = [[-1.0, -1.0, 2.5], [1.0, 1.0, 3.0]]\ndensity",
                            key + "materials[0]", "no particle is of the material")


if __name__ == "__main__":
    unittest.main()
