"""A bonded block of spheres, pulled apart, against YADE."""

import csv
import json
import os
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from wave import HERE, YADE, ReferenceTest, frames, largest_difference

K_N, K_T, GAP, EDGE = 1e7, 3e6, 0.1, 7.6e-3  # N/m, N/m, -, m


class Block(ReferenceTest):
    def pull(self, seed, strength, speed, end_time):
        """Runs kerf, then YADE on the same spheres and the same steps. -> both results"""
        layer = 0.8e-3
        case = self.write_case(f"""
[case]
name = "block"
dimension = 3
seed = {seed}
end_time = {end_time}
output.frames = 1
output.history = 100000

[participants.rock]
kind = "dem"
threads = 1
particles.packing = {{ region.box = [[0, 0, 0], [{EDGE}, {EDGE}, {EDGE}]], porosity = 0.4, radii = {{ law = "list", values = [0.5e-3] }} }}
material = {{ density = 2600.0, normal_stiffness = {K_N}, tangential_stiffness = {K_T}, tensile_strength = {strength}, shear_strength = {strength} }}
bonds = {{ gap_tolerance = {GAP}, shear_increment = "endpoint" }}

[[participants.rock.boundary]]
box = [[-1, -1, -1], [1, 1, {layer}]]
components = ["x", "y", "z", "rotation"]
motion = "fixed"

[[participants.rock.boundary]]
box = [[-1, -1, {EDGE - layer}], [1, 1, 1]]
components = ["x", "y", "z", "rotation"]
motion = "velocity"
velocity = [0.0, 0.0, {speed}]
""")
        folder = self.run_case(case, out=f"run{seed}-{strength}")
        record = json.loads((folder / "run.json").read_text())
        first, last = (h5py.File(frames(folder, "rock")[i])["particles"] for i in (0, -1))
        start = first["position"][:] - first["displacement"][:]
        held = np.flatnonzero(first["boundary"][:])
        velocity = np.zeros((len(held), 3))
        velocity[start[held, 2] > 0.5 * EDGE, 2] = speed
        yade = self.reference(
            ["yade", "-n", "-x", os.path.join(HERE, "yade_block.py")],
            dict(position=start, radius=first["radius"][:], mass=first["mass"][:], held=held,
                 velocity=velocity, time_step=record["time_step"], steps=record["steps"],
                 gap_tolerance=GAP, k_n=K_N, k_t=K_T, R_n=strength, R_t=strength))
        with open(folder / "history" / "rock.csv") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        ours = {name: np.array([float(row[name]) for row in rows])
                for name in ("time", "bonds", "external_work")}
        # The reaction of the pulled layer does all the work.
        ours["load"] = np.gradient(ours["external_work"], ours["time"]) / speed
        return start, last, ours, yade

    # Until the first bond breaks the steps are the same but for round-off. Tolerance: YADE keeps
    # positions as they are, 1e-18 m of displacements of 6e-7 m, which random-walks into the velocities,
    # and turns shear forces to first order.
    def test_until_a_bond_breaks_the_motion_is_that_of_yade(self):
        start, last, ours, yade = self.pull(seed=1, strength=1e9, speed=0.1, end_time=6e-6)
        self.assertGreater(len(start), 450)
        self.assertEqual(ours["bonds"][0], yade["bonds"][0])
        print(f"{len(start)} spheres, {int(yade['bonds'][0])} bonds, {len(yade['bonds'])} steps")
        for name, mine, theirs in (
                ("displacement", last["displacement"][:], yade["position"] - start),
                ("velocity", last["velocity"][:], yade["velocity"]),
                ("spin", last["angular_velocity"][:], yade["spin"])):
            difference = largest_difference(mine, theirs)
            self.verify(f"block of spheres pulled until a bond breaks: {name}", YADE, difference, 1e-9,
                        "YADE keeps positions, not displacements, and turns shear forces to first order")

    # Afterwards round-off decides which of two bonds breaks first. Tolerance: that of the mean over
    # five packings.
    def test_the_block_breaks_like_that_of_yade(self):
        broken, peak = [], []
        for seed in range(1, 6):
            _, _, ours, yade = self.pull(seed=seed, strength=10.0, speed=0.5, end_time=6e-5)
            broken.append((ours["bonds"][0] - ours["bonds"][-1], yade["bonds"][0] - yade["bonds"][-1]))
            peak.append((ours["load"].max(), yade["load"].max()))
            print(f"seed {seed}: broken bonds {broken[-1]}, peak load {peak[-1]} N")
        self.assertGreater(min(kerf for kerf, _ in broken), 20)
        for name, pairs in (("broken bonds", broken), ("peak load", peak)):
            kerf, yade = np.mean(pairs, axis=0)
            print(f"{name}: {kerf:.1f}, YADE {yade:.1f}")
            self.verify(f"block of spheres that breaks, mean of five: {name}", YADE, kerf / yade - 1.0,
                        0.05, "round-off decides which of two bonds breaks first")


if __name__ == "__main__":
    unittest.main()
