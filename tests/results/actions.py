"""What acts on bodies of elements by their cases: motions, loads, dashpots, walls, stress at the start."""

import math
import os
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import KerfTest, summary
from stretched import E, ELASTIC, LAMBDA, MU, NU, SIDE, record

RHO, C11 = 2600.0, LAMBDA + 2 * MU
BALANCE = '[[measures]]\nname = "energy_balance_error"\n'


def body(text, size=(SIDE, SIDE), count=(1, 1), end=1e-3, frames=1, history=100, case=""):
    """A case: a box of elements of one elastic material in plane strain."""
    return f"""[case]
name = "body"
dimension = 2
end_time = {end}
output = {{ frames = {frames}, history = {history} }}
{case}
[participants.body]
kind = "fem"
mesh = {{ origin = [0.0, 0.0], size = {list(size)}, count = {list(count)} }}
material = {{ {ELASTIC} }}
{text}
{BALANCE}"""


SYMMETRY = """
[[participants.body.boundary]]
tag = "left"
motion = "symmetry"
[[participants.body.boundary]]
tag = "bottom"
motion = "symmetry"
"""


class Actions(KerfTest):
    def table(self, run, name):
        with open(run / "history" / f"{name}.csv") as file:
            file.readline()
            names = file.readline().strip().split(",")
            rows = np.loadtxt(file, delimiter=",", ndmin=2).reshape(-1, len(names))
        return dict(zip(names, rows.T))

    def rows_of(self, run, what, number):
        """The rows of one boundary or load."""
        table = self.table(run, "body_" + {"boundary": "boundary", "load": "loads"}[what])
        return {name: values[table[what] == number] for name, values in table.items()}

    def assert_balance(self, run, most):
        self.assertLess(summary(run)["energy_balance_error"]["value"], most)


class Motions(Actions):
    def test_tables_move_a_body_and_its_supports_feel_stress_and_inertia(self):
        # One element of which every component is prescribed: x by a displacement that grows
        # evenly, y by a velocity a t. Each support holds half of the mass, and feels
        # sigma SIDE + m/2 a; all is linear in the displacements, so to rounding.
        strain, end, a = 1e-3, 1e-3, 40.0  # 1, s, m/s²
        run = self.run_case(self.write_case(body(SYMMETRY + f"""
[[participants.body.boundary]]
tag = "right"
components = ["x"]
motion = "displacement"
displacements = [[0.0, 0.0, 0.0], [{end}, {strain * SIDE}, 0.0]]
[[participants.body.boundary]]
tag = "top"
components = ["y"]
motion = "velocity"
velocities = [[0.0, 0.0, 0.0], [{end}, 0.0, {a * end}]]
""", end=end)))
        left, bottom, right, top = (self.rows_of(run, "boundary", k) for k in range(4))
        t = right["time"]
        e_x, e_y = strain * t / end, 0.5 * a * t**2 / SIDE
        np.testing.assert_allclose(right["displacement_x"], e_x * SIDE, atol=1e-12 * strain * SIDE)
        np.testing.assert_allclose(top["displacement_y"], e_y * SIDE, atol=1e-12 * strain * SIDE)
        np.testing.assert_array_equal(right["nodes"], 2.0)
        f_x, f_y = SIDE * (C11 * e_x + LAMBDA * e_y), SIDE * (C11 * e_y + LAMBDA * e_x)
        inertia = RHO * SIDE**2 / 2 * a
        after = slice(1, None)  # the first step begins to move
        scale = f_x.max()
        np.testing.assert_allclose(right["force_x"][after], f_x[after], atol=1e-9 * scale)
        np.testing.assert_allclose(left["force_x"][after], -f_x[after], atol=1e-9 * scale)
        np.testing.assert_allclose(top["force_y"][after], f_y[after] + inertia, atol=1e-9 * scale)
        np.testing.assert_allclose(bottom["force_y"][after], -f_y[after], atol=1e-9 * scale)
        self.assert_balance(run, 1e-12)


class Loads(Actions):
    def test_resultants_are_recorded_as_they_were_given(self):
        run = self.run_case(self.write_case(body(SYMMETRY + f"""
[[participants.body.loads]]
tag = "top"
force = [300.0, -200.0]
[[participants.body.loads]]
tag = "right"
tractions = [[0.0, 0.0, 0.0], [1e-3, 1e6, -2e6]]
[[participants.body.loads]]
box = [[{0.9 * SIDE}, {0.9 * SIDE}], [{1.1 * SIDE}, {1.1 * SIDE}]]
forces = [[0.0, 0.0, 0.0], [1e-3, 0.0, 50.0]]
[[participants.body.loads]]
tag = "right"
pressures = [[0.0, 0.0], [1e-3, 3e6]]
[[participants.body.probes]]
name = "top_right"
point = [{SIDE}, {SIDE}]
[[participants.body.probes]]
name = "bottom_right"
point = [{SIDE}, 0.0]
""", count=(3, 3))))
        force, traction, corner, pressure = (self.rows_of(run, "load", k) for k in range(4))
        top, bottom = self.table(run, "body_top_right"), self.table(run, "body_bottom_right")
        t = force["time"]
        np.testing.assert_allclose(force["force_x"], 300.0)
        np.testing.assert_allclose(force["force_y"], -200.0)
        np.testing.assert_allclose(traction["force_x"], 1e6 * SIDE * t / 1e-3, rtol=1e-12)
        np.testing.assert_allclose(traction["force_y"], -2e6 * SIDE * t / 1e-3, rtol=1e-12)
        np.testing.assert_allclose(corner["force_y"], 50.0 * t / 1e-3, rtol=1e-12)
        self.assertEqual((corner["nodes"][0], force["nodes"][0]), (1, 4))
        # Pressure acts on the faces where they are: its resultant is that of their chord
        height = SIDE + top["displacement_y"] - bottom["displacement_y"]
        width = top["displacement_x"] - bottom["displacement_x"]
        p = 3e6 * t / 1e-3
        np.testing.assert_allclose(pressure["force_x"], -p * height, rtol=1e-12)
        np.testing.assert_allclose(pressure["force_y"], p * width, rtol=1e-6, atol=1e-9 * 3e6 * SIDE)
        self.assert_balance(run, 1e-4)  # pressure on faces that move is not linear

    def test_at_rest_the_reactions_balance_the_loads(self):
        # A square that is pulled by a force along x, in plane strain: u = F (1 - nu²) / E. The
        # damping is twice the lowest frequency, sqrt(E' / rho) pi / 2 / SIDE: after 30 of its
        # periods over 2 pi little is left, 1e-6.
        damping = math.pi / SIDE * math.sqrt(E / RHO / (1 - NU**2))
        force = 1e4  # N per metre
        run = self.run_case(self.write_case(body(f"""
damping = {{ mass = {damping} }}
loads = [{{ tag = "right", force = [{force}, 0.0] }}]
""" + SYMMETRY, count=(2, 2), end=60 / damping)))
        left, bottom = self.rows_of(run, "boundary", 0), self.rows_of(run, "boundary", 1)
        self.assertAlmostEqual(left["force_x"][-1] / force, -1.0, delta=1e-6)
        self.assertAlmostEqual(bottom["force_y"][-1] / force, 0.0, delta=1e-6)
        with h5py.File(sorted((run / "frames").glob("body_*.h5"))[-1]) as file:
            u, stress = file["mesh/displacement"][:], file["mesh/stress"][:]
        exact = force * (1 - NU**2) / E
        np.testing.assert_allclose(u[:, 0].max(), exact, rtol=1e-5)
        np.testing.assert_allclose(stress[:, 0], force / SIDE, rtol=1e-5)


class Ground(Actions):
    def test_stress_that_grows_with_depth_rests_on_its_supports(self):
        # sigma_v = -(p + rho g z), linear in z, is met exactly at the points: only rounding moves,
        # which is compared with what the weight would do: g t² / 2.
        width, height, g, p, k0, end = 8.0, 6.0, 9.81, 2e5, 0.4, 0.02
        run = self.run_case(self.write_case(body(f"""
gravity = [0.0, {-g}]
in_situ_stress = {{ K0 = {k0}, surface = {height}, overburden = {p} }}
loads = [{{ tag = "top", pressure = {p} }}]
""" + SYMMETRY + """
[[participants.body.boundary]]
tag = "right"
motion = "symmetry"
""", size=(width, height), count=(4, 6), end=end)))
        with h5py.File(sorted((run / "frames").glob("body_*.h5"))[-1]) as file:
            u, stress = file["mesh/displacement"][:], file["mesh/stress"][:]
        self.assertLess(np.abs(u).max(), 1e-9 * g * end**2 / 2)
        row = np.arange(24) // 4
        vertical = -(p + RHO * g * (height - (row + 0.5) * 1.0))
        np.testing.assert_allclose(stress[:, 1], vertical, rtol=1e-9)
        np.testing.assert_allclose(stress[:, 0], k0 * vertical, rtol=1e-9)
        np.testing.assert_allclose(stress[:, 2], k0 * vertical, rtol=1e-9)
        bottom, right = self.rows_of(run, "boundary", 1), self.rows_of(run, "boundary", 2)
        np.testing.assert_allclose(bottom["force_y"], (p + RHO * g * height) * width, rtol=1e-9)
        np.testing.assert_allclose(right["force_x"], -k0 * height * (p + RHO * g * height / 2),
                                   rtol=1e-9)

    def test_a_uniform_stress_is_that_of_the_case(self):
        stress = [-5e6, -12e6, -3e6, 2e6]  # xx yy zz xy, Pa
        run = self.run_case(self.write_case(body(f"""
in_situ_stress.stress = {stress}
boundary = [{{ tag = "all", motion = "fixed" }}]
probes = [{{ name = "middle", point = [0.05, 0.05] }}]
""", count=(3, 3))))
        probe = self.table(run, "body_middle")
        for name, value in zip(("xx", "yy", "zz", "xy"), stress):
            np.testing.assert_array_equal(probe["stress_" + name], value)


class Waves(Actions):
    LENGTH, COUNT = 0.2, 200

    def column(self, across, polarization, speed):
        """A column along y into which a pulse comes from below; it may leave above."""
        self.speed, self.duration, self.velocity = speed, 0.04 / speed, 0.01
        return body(f"""
boundary = [{{ tag = "all", components = ["{across}"], motion = "fixed" }}]
absorbing = [{{ tag = "top" }}, {{ tag = "bottom", wave = {{ direction = [0.0, 3.0], {polarization}
velocity = {self.velocity}, duration = {self.duration} }} }}]
probes = [{{ name = "middle", point = [0.00025, {self.LENGTH / 2 + 0.00025}] }}]
""".replace("\nvelocity", " velocity"), size=(1e-3, self.LENGTH), count=(1, self.COUNT),
                    end=1.5 * self.LENGTH / speed, history=2000)

    def test_plane_waves_come_in_as_they_are_and_leave(self):
        # v(t - y/c) in the middle. Lumped elements carry waves of 40 elements slower by
        # (2 pi / 40)² / 24 = 1e-3 (less with a step near the critical one): after 100 elements the
        # pulse is late by 0.1 of them, and its steepest slope is pi V / 40 each: 0.8 %. The pulse
        # has shorter waves, too: twice that. What stays behind is what dispersion made of it.
        for name, across, polarization, speed in (
                ("P", "x", "", math.sqrt(C11 / RHO)),
                ("S", "y", "polarization = [1.0, 0.0],", math.sqrt(MU / RHO))):
            with self.subTest(wave=name):
                run = self.run_case(self.write_case(self.column(across, polarization, speed)), out=name)
                probe, energy = self.table(run, "body_middle"), self.table(run, "body")
                half = record(run)["time_step"] / 2
                t = probe["time"] + half - (self.LENGTH / 2 + 0.00025) / speed
                inside = (t > 0) & (t < self.duration)
                exact = np.where(inside, self.velocity * np.sin(np.pi * t / self.duration)**2, 0.0)
                v = probe["velocity_" + ("x" if name == "S" else "y")]
                error = np.abs(v - exact).max() / self.velocity
                print(f"{name} wave: largest error {error:.2e} of the amplitude")
                self.assertLess(error, 0.016)
                stored = energy["kinetic_energy"] + energy["elastic_energy"]
                self.assertLess(stored[-1], 1e-5 * stored.max())
                self.assert_balance(run, 1e-10)


class Walls(Actions):
    def test_a_wall_that_pushes_feels_the_impedance(self):
        # Uniaxial strain behind a front: sigma = -rho c_P v until the front comes back. The mean
        # over that time, because elements ring behind a sharp front.
        c, v, length = math.sqrt(C11 / RHO), 0.1, 0.4
        run = self.run_case(self.write_case(body(f"""
boundary = [{{ tag = "all", components = ["y"], motion = "fixed" }}]
walls = [{{ name = "ram", tag = "left", point = [0.0, 0.0], normal = [2.0, 0.0], velocity = {v} }}]
""", size=(length, 0.01), count=(200, 2), end=length / c, history=1000)))
        ram = self.table(run, "body_ram")
        np.testing.assert_allclose(ram["position_x"], v * ram["time"], atol=1e-15)
        np.testing.assert_allclose(ram["velocity_x"], v)
        self.assertAlmostEqual(ram["force_x"].mean() / (-RHO * c * v * 0.01), 1.0, delta=0.01)
        np.testing.assert_array_equal(ram["force_y"], 0.0)

    def test_friction_slows_a_sliding_block_down(self):
        # The mean of the normal force is the weight: v = v0 - mu g t, but for the block's own
        # vibration on the wall.
        mu, g, v0, end = 0.3, 9.81, 0.5, 0.05
        run = self.run_case(self.write_case(body(f"""
gravity = [0.0, {-g}]
initial = [{{ kind = "velocity", velocity = [{v0}, 0.0] }}]
walls = [{{ name = "floor", tag = "bottom", point = [0.0, 0.0], normal = [0.0, 1.0], friction = {mu} }}]
""", count=(2, 2), end=end)))
        history, floor = self.table(run, "body"), self.table(run, "body_floor")
        v = history["momentum_x"] / (RHO * SIDE**2)
        self.assertAlmostEqual((v0 - v[-1]) / (mu * g * history["time"][-1]), 1.0, delta=0.01)
        self.assertTrue((floor["force_y"] <= 0.0).all() and (floor["force_x"] >= 0.0).all())


class Statics(Actions):
    def test_a_heavier_body_comes_to_the_same_rest_in_fewer_steps(self):
        # A bar in plane strain under tension that stops at every peak of its kinetic energy, with
        # its own masses and with four times these, which double the step.
        tension, length = 1e6, 8 * SIDE  # Pa, m
        wanted = length * tension * (1 - NU**2) / E
        steps = []
        for factor in (1.0, 4.0):
            scaling = f"mass_scaling = {{ factor = {factor} }}" if factor > 1.0 else ""
            run = self.run_case(self.write_case(body(f"""
damping = {{ kinetic = true }}
{scaling}
{SYMMETRY}
[[participants.body.loads]]
tag = "right"
traction = [{tension}, 0.0]
[[participants.body.probes]]
name = "end"
point = [{length}, {0.5 * SIDE}]
""", size=(length, SIDE), count=(16, 2), end=10.0,
                case='stop = [{ name = "at_rest", quantity = "unbalanced_force", below = 1e-9, '
                     'after = 1e-3 }]')))
            history = self.table(run, "body")
            self.assertLess(history["unbalanced_force"][-1], 1e-9)
            displacement = self.table(run, "body_end")["displacement_x"][-1]
            self.assertAlmostEqual(displacement, wanted, delta=1e-7 * wanted)
            self.assert_balance(run, 1e-9)  # linear: what the stops take is booked
            steps.append(history["step"][-1])
            if factor > 1.0:
                scaled = record(run)["participants"]["body"]["summary"]["mass_scaling"]
                self.assertEqual(scaled["elements"], 32)
                self.assertAlmostEqual(scaled["added_mass"], 3 * RHO * length * SIDE, places=6)
        self.assertLess(steps[1], 0.7 * steps[0])


if __name__ == "__main__":
    unittest.main()
