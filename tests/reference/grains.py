"""Grains without bonds against YADE: a column that settles, a tool that is dragged through a bed."""

import csv
import json
import os
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from wave import HERE, YADE, ReferenceTest, frames

R, K_N, RATIO, FRICTION = 5e-3, 1e5, 0.3, 0.4  # m, N/m, k_t / k_n, -
MASS = 2600.0 * 4 / 3 * np.pi * R**3  # kg
GRAVITY = [0.0, 0.0, -9.81]


def history(folder, name):
    with open(folder / "history" / (name + ".csv")) as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}


def stl(facets):
    """Text of a surface in ASCII STL."""
    text = "solid tool\n"
    for corners in facets:
        vertices = "".join(f"vertex {x!r} {y!r} {z!r}\n" for x, y, z in np.asarray(corners).tolist())
        text += f"facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n"
    return text + "endsolid tool\n"


def box_facets(low, high):
    """The 12 triangles around a box, seen from outside."""
    corner = np.array([[(high if k >> a & 1 else low)[a] for a in range(3)] for k in range(8)])
    return corner[[(0, 2, 3), (0, 3, 1), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 6, 7), (2, 7, 3),
                   (0, 4, 6), (0, 6, 2), (1, 3, 7), (1, 7, 5)]]


class Grains(ReferenceTest):
    def both(self, position, size, steps, every, damping, dt=2e-5, k_n=K_N,
             facets=(), velocity=(0, 0, 0), out="run"):
        """Runs the same grains in a box (open above) in kerf and in YADE. -> both results"""
        (self.folder / "grains.txt").write_text(
            "".join(f"{x!r} {y!r} {z!r} {R!r}\n" for x, y, z in position.tolist()))
        walls = [(axis, sense, size[axis] if sense < 0 else 0.0)
                 for axis, sense in ((0, 1), (0, -1), (1, 1), (1, -1), (2, 1))]
        tools = ""
        for k, (axis, sense, place) in enumerate(walls):
            point, normal = np.zeros(3), np.zeros(3)
            point[axis], normal[axis] = place, sense
            tools += (f'[[participants.grains.tools]]\nname = "wall{k}"\nshape = "plane"\n'
                      f"point = {point.tolist()}\nnormal = {normal.tolist()}\n"
                      f"normal_stiffness = {k_n}\ntangential_stiffness = {RATIO * k_n}\nfriction = {FRICTION}\n")
        if len(facets):
            (self.folder / "tool.stl").write_text(stl(facets))
            tools += ('[[participants.grains.tools]]\nname = "tool"\nshape = "file"\nfile = "tool.stl"\n'
                      f"normal_stiffness = {4 / 3 * k_n}\ntangential_stiffness = {4 / 3 * RATIO * k_n}\n"
                      f"friction = {FRICTION}\nvelocity = {list(map(float, velocity))}\n")
        case = self.write_case(f"""
[case]
name = "grains"
dimension = 3
end_time = {steps * dt!r}
time_step = {dt}
output.frames = {0 if len(facets) else steps // every}
output.history = {steps // every}

[participants.grains]
kind = "dem"
threads = 1
particles.file = "grains.txt"
gravity = {GRAVITY}
material = {{ density = 2600.0, normal_stiffness = {k_n}, tangential_stiffness = {RATIO * k_n}, friction = {FRICTION} }}
bonds = {{ kind = "none", shear_increment = "endpoint" }}
damping = {{ kind = "componentwise", translation = {damping}, rotation = {damping} }}
{tools}""")
        folder = self.run_case(case, out=out)
        record = json.loads((folder / "run.json").read_text())
        self.assertEqual((record["steps"], record["time_step"]), (steps, dt))
        rows = history(folder, "grains")
        self.assertEqual(list(rows["step"][:2]), [0, every])
        ours = {"energy": rows["kinetic_energy"], "height": []}
        for path in frames(folder, "grains"):
            with h5py.File(path) as frame:
                ours["height"].append(frame["particles/position"][:, 2])
        if len(facets):
            tool = history(folder, "grains_tool")
            ours["force"] = np.stack([tool[f"force_{a}"] for a in "xyz"], axis=1)
        yade = self.reference(
            ["yade", "-n", "-x", os.path.join(HERE, "yade_grains.py")],
            dict(position=position, radius=R, mass=MASS, k_n=k_n, k_t=RATIO * k_n, friction=FRICTION,
                 gravity=GRAVITY, damping=damping, time_step=dt, steps=steps, every=every,
                 walls=np.array(walls, dtype=float), facets=np.asarray(facets), tool_velocity=velocity))
        count = len(yade["energy"])
        return {name: np.array(values)[:count] for name, values in ours.items()}, yade

    # 500 spheres fall from a loose lattice, shaken by 5 % of their size, and come to rest. Their paths
    # are chaotic, the column as a whole is not.
    def test_a_column_that_settles(self):
        random = np.random.default_rng(1)
        count, pitch = (9, 9, 12), 2.8 * R
        position = np.stack(np.meshgrid(*map(np.arange, count), indexing="ij"), axis=-1).reshape(-1, 3)
        position = (position + 0.5 + random.uniform(-0.14, 0.14, position.shape)) * pitch
        ours, yade = self.both(position, np.array(count) * pitch, steps=15000, every=100, damping=0.2)
        self.assertLess(yade["energy"][-1], 0.01 * yade["energy"].max())
        def compare(what, kerf, yade, tolerance, chaos):
            self.verify("settling column of spheres: " + what, YADE, kerf / yade - 1.0, tolerance,
                        "chaos: two runs of kerf whose starts differ by 1e-14 m differ by " + chaos)

        mine, theirs = ours["energy"], yade["energy"]
        compare("largest kinetic energy", mine.max(), theirs.max(), 0.02, "0.0005")
        compare("kinetic energy, mean over time", mine.mean(), theirs.mean(), 0.02, "0.006")
        compare("kinetic energy, rms of the difference over rms", 1.0 + np.linalg.norm(mine - theirs) /
                np.linalg.norm(theirs), 1.0, 0.03, "0.016")
        mine, theirs = ours["height"][-1], yade["height"][-1]
        compare("final mean height", mine.mean(), theirs.mean(), 0.02, "0.0016")
        compare("final height that 95 % are below", np.percentile(mine, 95), np.percentile(theirs, 95),
                0.02, "0.002")

    # A plate pushes its way for 5 cm through 400 spheres. Its force fluctuates by half of its mean. In
    # one bed the mean force of kerf and of YADE differs by 5 %, and that of two runs of kerf whose starts
    # differ by 1e-14 m by as much. So it is the mean of eight beds.
    def test_a_plate_that_is_dragged_through_a_bed(self):
        count, pitch = (14, 6, 5), 2.05 * R
        low, high = np.array([3.0, 1.0, 1.5]) * pitch, np.array([4.0, 5.0, 8.0]) * pitch
        beds = []
        for seed in range(8):
            random = np.random.default_rng(seed)
            position = np.stack(np.meshgrid(*map(np.arange, count), indexing="ij"), axis=-1)
            position = position.reshape(-1, 3) + 0.5 + random.uniform(-0.02, 0.02, (np.prod(count), 3))
            position *= pitch
            outside = np.maximum(low - position, position - high).max(axis=1) > R
            results = self.both(position[outside], np.array(count) * pitch, steps=4000, every=10,
                                damping=0.2, dt=6e-5, k_n=2e4, facets=box_facets(low, high),
                                velocity=(0.2, 0.0, 0.0), out=f"bed{seed}")
            moving = slice(len(results[1]["force"]) // 10, None)  # the bed has fallen onto the floor
            beds.append([result["force"][moving, 0].mean() for result in results])
            print(f"bed {seed}: mean force {beds[-1]} N")
        kerf, yade = np.mean(beds, axis=0)
        self.verify("plate dragged through spheres: mean force, mean of eight beds", YADE,
                    kerf / yade - 1.0, 0.05,
                    "chaos: single beds scatter by 0.05, so their mean by 0.02")


if __name__ == "__main__":
    unittest.main()
