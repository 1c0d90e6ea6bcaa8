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
