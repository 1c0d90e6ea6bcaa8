"""The engines against independent codes on the same input. A code that is missing is a failure."""

import json
import os
import subprocess
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import KerfTest

YADE = "YADE 2023.02"
HERE = os.path.dirname(os.path.abspath(__file__))


def frames(folder, participant):
    return sorted((folder / "frames").glob(f"{participant}_*.h5"))


def largest_difference(a, b):
    """Relative to the largest value of the reference."""
    return np.abs(a - b).max() / np.abs(b).max()


class ReferenceTest(KerfTest):
    def reference(self, command, given):
        """Runs a script of a reference code on the input. -> its output"""
        np.savez(self.folder / "input.npz", **given)
        result = subprocess.run([*command, self.folder / "input.npz", self.folder / "output.npz"],
                                stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=600,
                                env={**os.environ, "OMP_NUM_THREADS": "1"})
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return dict(np.load(self.folder / "output.npz"))


class Wave(ReferenceTest):
    # YADE 2023.02 with the bonded law JCFpm, no damping; 20 x 10 discs in close-packed rows, free
    # all around but for the driven column. Tolerance: YADE keeps positions as they are, round-off of
    # 3e-18 m against displacements of 1e-7 m, and it turns the shear force to first order.
    def test_a_wave_in_a_bonded_lattice_is_that_of_yade(self):
        k_n, k_t, duration, amplitude = 1.6e10, 3.2e9, 3e-6, 1e-7
        case = self.write_case(f"""
[case]
name = "lattice"
dimension = 2
end_time = 1e-5
output.frames = 1

[participants.rock]
kind = "dem"
particles.lattice = {{ type = "triangular", spacing = 1e-3, origin = [0.0, 0.0], count = [20, 10] }}
material = {{ density = 2600.0, normal_stiffness = {k_n}, tangential_stiffness = {k_t} }}
bonds = {{ shear_increment = "endpoint" }}
boundary = [{{ box = [[-1e-4, -1.0], [6e-4, 1.0]], motion = "hann", amplitude = [{amplitude}, 0.0], duration = {duration} }}]
""")
        folder = self.run_case(case)
        record = json.loads((folder / "run.json").read_text())
        first, last = (h5py.File(frames(folder, "rock")[i]) for i in (0, -1))
        start = first["particles/position"][:] - first["particles/displacement"][:]
        dt, steps = record["time_step"], record["steps"]
        t = np.arange(steps + 1) * dt
        u = np.where(t <= duration, amplitude * (1 - np.cos(2 * np.pi * t / duration)) / 2, 0.0)
        driven = np.flatnonzero(start[:, 0] < 6e-4)
        self.assertEqual(len(driven), 10)
        yade = self.reference(
            ["yade", "-n", "-x", os.path.join(HERE, "yade_lattice.py")],
            dict(position=start, radius=first["particles/radius"][:], mass=first["particles/mass"][:],
                 driven=driven, velocity=np.diff(u) / dt, time_step=dt, steps=steps, k_n=k_n, k_t=k_t))
        self.assertEqual(yade["bonds"], len(first["contacts/cells"]))
        for name, ours, theirs in (
                ("displacement", last["particles/displacement"][:], yade["position"] - start),
                ("velocity", last["particles/velocity"][:], yade["velocity"]),
                ("spin", last["particles/angular_velocity"][:].reshape(len(start), -1)[:, -1],
                 yade["spin"])):
            difference = largest_difference(ours, theirs)
            self.verify(f"wave in a lattice of bonded discs: {name}", YADE, difference, 1e-9,
                        "YADE keeps positions, not displacements, and turns shear forces to first order")

    # FEniCSx 0.5.2, linear elasticity on Q1, the same scheme: what differs is the order of sums.
    def test_a_pulse_in_a_bar_of_quadrilaterals_is_that_of_fenicsx(self):
        E, nu, density = 2e10, 0.25, 2400.0
        case = self.write_case(f"""
[case]
name = "bar"
dimension = 2
end_time = 2e-5
output.frames = 1

[participants.bar]
kind = "fem"
mesh = {{ type = "box", origin = [0.0, 0.0], size = [64e-3, 6e-3], count = [64, 5] }}
material = {{ density = {density}, young_modulus = {E}, poisson_ratio = {nu} }}
boundary = [{{ tag = "right", motion = "fixed" }}]
initial = [{{ kind = "pulse", amplitude = 1e-6, center = 20e-3, length = 16e-3, wave_speed = 3100.0 }}]
""")
        folder = self.run_case(case)
        record = json.loads((folder / "run.json").read_text())
        first, last = (h5py.File(frames(folder, "bar")[i]) for i in (0, -1))
        u = first["mesh/displacement"][:]
        start = first["mesh/position"][:] - u
        right = np.isclose(start[:, 0], 64e-3)
        fenicsx = self.reference(
            ["/usr/bin/python3", os.path.join(HERE, "fenicsx_bar.py")],
            dict(position=start, displacement=u, velocity=first["mesh/velocity"][:], count=[64, 5],
                 fixed=np.repeat(right[:, None], 3, axis=1).astype(float), density=density,
                 lam=E * nu / ((1 + nu) * (1 - 2 * nu)), mu=E / (2 * (1 + nu)),
                 time_step=record["time_step"], steps=record["steps"]))
        for name in ("displacement", "velocity"):
            difference = largest_difference(last[f"mesh/{name}"][:], fenicsx[name])
            self.verify(f"pulse in a bar of quadrilaterals: {name}", "FEniCSx 0.5.2", difference, 1e-9,
                        "order of sums")


if __name__ == "__main__":
    unittest.main()
