"""Two spheres against YADE: a bond that is pulled, sheared and broken, and friction."""

import json
import os
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from wave import HERE, YADE, ReferenceTest, frames

R, K_N, K_T = 0.5e-3, 1e7, 3e6  # m, N/m, N/m
ALONG = np.array([1.0, 2.0, 2.0]) / 3.0  # from the first to the second centre: no axis is special
ACROSS = np.array([2.0, 1.0, -2.0]) / 3.0
DT = 5e-8  # s; a swing takes 1.5e-6 s or more


class Pair(ReferenceTest):
    def both(self, velocity, steps, blocked=("", ""), distance=2 * R, bonded=True, friction=0.0,
             R_n=1e9, R_t=1e9):
        """The same pair in kerf and in YADE. `blocked` as YADE's blockedDOFs: "", "xyz" or "xyzXYZ".
        -> both results, of every step"""
        position = np.array([0 * ALONG, distance * ALONG])
        (self.folder / "pair.txt").write_text(
            "".join(f"{x[0]!r} {x[1]!r} {x[2]!r} {R!r}\n" for x in position.tolist()))
        extra = ""
        for x, v, held in zip(position, np.asarray(velocity), blocked):
            box = [(x - 0.1 * R).tolist(), (x + 0.1 * R).tolist()]
            if held:
                components = ["x", "y", "z"] + (["rotation"] if "X" in held else [])
                extra += (f"[[participants.pair.boundary]]\nbox = {box}\ncomponents = {components}\n"
                          f'motion = "velocity"\nvelocity = {v.tolist()}\n')
            else:
                extra += (f'[[participants.pair.initial]]\nkind = "velocity"\nbox = {box}\n'
                          f"velocity = {v.tolist()}\n")
        case = self.write_case(f"""
[case]
name = "pair"
dimension = 3
end_time = {steps * DT!r}
time_step = {DT}
allow_unstable = true
output.frames = {steps}

[participants.pair]
kind = "dem"
threads = 1
particles.file = "pair.txt"
material = {{ density = 2600.0, normal_stiffness = {K_N}, tangential_stiffness = {K_T}, friction = {friction}, tensile_strength = {R_n}, shear_strength = {R_t} }}
bonds = {{ kind = "{'brittle' if bonded else 'none'}", shear_increment = "endpoint" }}
{extra}""")
        folder = self.run_case(case)
        record = json.loads((folder / "run.json").read_text())
        self.assertEqual((record["steps"], record["time_step"]), (steps, DT))
        ours = {name: [] for name in ("position", "velocity", "spin", "normal_force", "shear_force",
                                      "holds")}
        for path in frames(folder, "pair")[:steps]:
            with h5py.File(path) as frame:
                p, c = frame["particles"], frame["contacts"]
                mass = p["mass"][:]
                ours["position"].append(p["position"][:])
                ours["velocity"].append(p["velocity"][:])
                ours["spin"].append(p["angular_velocity"][:])
                there = len(c["bonded"]) == 1
                ours["normal_force"].append(c["normal_force"][0] if there else 0.0)
                ours["shear_force"].append(c["tangential_force"][0] if there else np.zeros(3))
                ours["holds"].append(there and c["bonded"][0] == 1)
        yade = self.reference(
            ["yade", "-n", "-x", os.path.join(HERE, "yade_pair.py")],
            dict(position=position, velocity=velocity, radius=[R, R], mass=mass, blocked=blocked,
                 bonded=bonded, friction=friction, k_n=K_N, k_t=K_T, R_n=R_n, R_t=R_t,
                 time_step=DT, steps=steps))
        return {name: np.array(values) for name, values in ours.items()}, yade

    def compare(self, what, ours, yade, names, reason, tolerance=1e-9):
        for name in names:
            mine, theirs = ours[name], yade[name]
            if name == "position":
                mine, theirs = mine - mine[0], theirs - theirs[0]
            self.assertGreater(np.abs(theirs).max(), 0.0, name)
            self.verify(f"{what}: {name.replace('_', ' ')}", YADE,
                        np.abs(mine - theirs).max() / np.abs(theirs).max(), tolerance, reason)

    def test_a_bond_that_is_pulled(self):
        ours, yade = self.both([-0.1 * ALONG, 0.1 * ALONG], steps=200)
        self.compare("pulled bond", ours, yade, ("position", "velocity", "normal_force"),
                     "YADE keeps positions: 1e-19 m of 1e-8 m a step")

    def test_a_bond_that_is_sheared(self):
        ours, yade = self.both([-0.01 * ACROSS, 0.01 * ACROSS], steps=200)
        self.compare("sheared bond", ours, yade, ("position", "velocity", "spin", "shear_force"),
                     "YADE keeps positions: 1e-19 m of 1e-9 m a step, and turns shear forces to first order")

    # While a bond turns by theta in N steps with a force that grows, YADE's first order makes it
    # theta² / 4N too large: 2e-10 here.
    def test_a_bond_that_breaks(self):
        for what, direction, blocked in (("tension", ALONG, "xyzXYZ"), ("shear", ACROSS, "xyzXYZ")):
            k = K_N if what == "tension" else K_T
            speed, strength = 0.02, 2.005  # not a whole number of steps
            ours, yade = self.both([0 * ALONG, speed * direction], blocked=(blocked, blocked),
                                   R_n=strength, R_t=strength,
                                   steps=int(1.2 * strength / (k * speed * DT)))
            breaks = [int(np.argmin(result["holds"][1:])) + 1 for result in (ours, yade)]
            self.assertGreater(breaks[1], 50)
            force = "normal_force" if what == "tension" else "shear_force"
            self.verify(f"bond broken by {what}: step in which it breaks", YADE, breaks[0] - breaks[1],
                        0, "whole steps")
            self.compare(f"bond broken by {what}", ours, yade, (force,),
                         "YADE keeps positions, and turns shear forces to first order")

    # Until the contact slides the force is too large by the same theta² / 4N = 2e-10; then friction
    # sets its size.
    def test_spheres_that_slide_on_each_other(self):
        speed, overlap = 0.1, 1e-4
        for what, friction, blocked in (("slides", 0.4, "xyzXYZ"), ("slides, then rolls", 0.01, "xyz")):
            ours, yade = self.both([0 * ALONG, speed * ACROSS], blocked=("xyzXYZ", blocked),
                                   distance=2 * R * (1 - overlap), bonded=False, friction=friction, steps=400)
            slipped = np.linalg.norm(yade["shear_force"], axis=1) / -yade["normal_force"]
            self.assertAlmostEqual(slipped[60] / friction, 1.0, delta=1e-9)
            self.assertEqual(slipped[-1] < 0.99 * friction, blocked == "xyz")
            names = ("normal_force", "shear_force") + (("spin",) if blocked == "xyz" else ())
            self.compare(f"sphere that {what} on another", ours, yade, names,
                         "YADE turns shear forces to first order")


if __name__ == "__main__":
    unittest.main()
