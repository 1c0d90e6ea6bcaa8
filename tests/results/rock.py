"""What a user finds in the results of a run whose rock breaks."""

import os
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import KerfTest, summary

COLUMNS, ROWS, SPACING = 14, 9, 1e-3
K_N, K_T = 1e10, 2e9  # N/m
PULLED_APART = f"""
[case]
name = "pulled_apart"
dimension = 2
end_time = 1.5e-4
output = {{ frames = 6, history = 300 }}

[participants.rock]
kind = "dem"
particles.lattice = {{ type = "triangular", spacing = 1e-3, origin = [0.0, 0.0], count = [{COLUMNS}, {ROWS}] }}
material = {{ density = 2600.0, normal_stiffness = 1e10, tangential_stiffness = 2e9, \
tensile_strength = 1e4, shear_strength = 2e3, friction = 0.5 }}
damping = {{ translation = 0.3, rotation = 0.3 }}
boundary = [{{ box = [[-1e-4, -1.0], [6e-4, 1.0]], motion = "fixed" }},
            {{ box = [[12.9e-3, -1.0], [13.6e-3, 1.0]], motion = "velocity", velocity = [0.3, 0.05] }}]
probes = [{{ name = "middle", box = [[3.3e-3, 1.1e-3], [10.3e-3, 6.3e-3]] }}]

[[measures]]
name = "coordination_number"
participant = "rock"
"""


def table(folder, name):
    with open(folder / "history" / f"{name}.csv") as file:
        file.readline()  # units
        names = file.readline().strip().split(",")
        rows = np.loadtxt(file, delimiter=",", ndmin=2).reshape(-1, len(names))
    return dict(zip(names, rows.T))


def frames(folder):
    found = []
    for path in sorted((folder / "frames").glob("rock_*.h5")):
        with h5py.File(path) as file:
            found.append({f"{grid}/{name}": data[:] for grid in ("particles", "contacts")
                          for name, data in file[grid].items()})
    return found


def held(frame):
    """The bonds of a frame as pairs of ids."""
    return {tuple(c) for c, b in zip(frame["contacts/cells"], frame["contacts/bonded"]) if b}


def pieces(frame):
    """Groups of ids that bonds hold together, the largest first, then by the smallest id."""
    neighbours = {i: [] for i in range(len(frame["particles/id"]))}
    for i, j in held(frame):
        neighbours[i].append(j)
        neighbours[j].append(i)
    found, seen = [], set()
    for start in neighbours:
        group, todo = set(), [start]
        while todo:
            i = todo.pop()
            if i not in seen:
                seen.add(i)
                group.add(i)
                todo += neighbours[i]
        if group:
            found.append(group)
    return sorted(found, key=lambda group: (-len(group), min(group)))


class Rock(KerfTest):
    @classmethod
    def setUpClass(cls):
        runner = cls("setUp")
        runner.setUp()
        cls.addClassCleanup(runner.doCleanups)
        cls.run_folder = runner.run_case(runner.write_case(PULLED_APART))
        cls.frames = frames(cls.run_folder)
        cls.history = table(cls.run_folder, "rock")
        cls.cracks = table(cls.run_folder, "rock_cracks")
        cls.probe = table(cls.run_folder, "rock_middle")

    def test_rows_of_particles_are_in_the_order_of_the_lattice(self):
        k = np.arange(COLUMNS * ROWS)
        row = k // COLUMNS
        x = SPACING * (k % COLUMNS + 0.5 * (row % 2))
        for frame in self.frames:
            np.testing.assert_array_equal(frame["particles/id"], k)
            start = frame["particles/position"] - frame["particles/displacement"]
            np.testing.assert_allclose(start[:, 0], x, atol=1e-12)
            np.testing.assert_allclose(start[:, 1], row * SPACING * np.sqrt(0.75), atol=1e-12)

    def test_rows_of_contacts_ascend_by_the_ids_of_their_particles(self):
        for frame in self.frames:
            pairs = [tuple(c) for c in frame["contacts/cells"]]
            self.assertEqual(pairs, sorted(pairs))
            self.assertTrue(all(i < j for i, j in pairs))

    def test_every_lost_bond_has_a_row_in_the_list_of_cracks(self):
        lost = held(self.frames[0]) - held(self.frames[-1])
        listed = [(int(i), int(j)) for i, j in zip(self.cracks["first"], self.cracks["second"])]
        print(f"{len(lost)} bonds broke, {int(self.cracks['mode'].sum())} of them in shear")
        self.assertGreater(len(lost), 10)
        self.assertEqual(len(listed), len(set(listed)))
        self.assertEqual(set(listed), lost)
        self.assertEqual(sorted(set(self.cracks["mode"])), [0.0, 1.0])

    def test_a_crack_tells_strength_normal_and_place(self):
        c = self.cracks
        np.testing.assert_array_equal(c["strength"], np.where(c["mode"] == 0, 1e4, 2e3))
        np.testing.assert_allclose(np.hypot(c["normal_x"], c["normal_y"]), 1.0, rtol=1e-12)
        start = self.frames[0]["particles/position"]
        i, j = c["first"].astype(int), c["second"].astype(int)
        n = np.column_stack([c["normal_x"], c["normal_y"]])
        self.assertTrue((np.sum(n * (start[j] - start[i])[:, :2], axis=1) > 0.9 * SPACING).all())
        place = np.column_stack([c["x"], c["y"]])
        middle = 0.5 * (start[i] + start[j])[:, :2]
        moved = 0.3 * 1.5e-4  # m, of the fastest boundary
        self.assertLess(np.abs(place - middle).max(), 2 * moved)

    def test_history_counts_cracks_by_mode_and_books_their_energy(self):
        h, c = self.history, self.cracks
        for step, tension, shear, broken, energy in zip(
                h["step"], h["tension_cracks"], h["shear_cracks"], h["broken_bonds"],
                h["fracture_dissipation"]):
            until = c["step"] <= step
            self.assertEqual(tension, np.sum(until & (c["mode"] == 0)))
            self.assertEqual(shear, np.sum(until & (c["mode"] == 1)))
            self.assertEqual(broken, tension + shear)
            np.testing.assert_allclose(energy, np.sum(c["energy"][until]), rtol=1e-12)

    def test_fragments_are_the_pieces_that_bonds_hold_together(self):
        for frame in self.frames:
            numbers = frame["particles/fragment"]
            for number, group in enumerate(pieces(frame)):
                self.assertEqual(set(np.flatnonzero(numbers == number)), group)
        last = pieces(self.frames[-1])
        print(f"{len(last)} fragments, the largest of {len(last[0])} particles")
        self.assertGreater(len(last), 1)
        self.assertEqual(self.history["fragments"][0], 1)
        self.assertEqual(self.history["largest_fragment"][0], 1)
        self.assertAlmostEqual(self.history["largest_fragment"][-1], len(last[0]) / (COLUMNS * ROWS))

    def test_a_probe_reads_the_elastic_law_of_the_lattice_before_it_breaks(self):
        # C11 = sqrt(3)/4 (3 k_n + k_t), C12 = sqrt(3)/4 (k_n - k_t). The pull is not uniform over
        # the box: 2 %.
        C11, C12 = np.sqrt(3) / 4 * (3 * K_N + K_T), np.sqrt(3) / 4 * (K_N - K_T)
        p = self.probe
        whole = p["time"] < 0.9 * self.cracks["time"].min()
        late = whole & (p["time"] > 0.5 * self.cracks["time"].min())
        expected = C11 * p["strain_xx"] + C12 * p["strain_yy"]
        error = np.abs(p["stress_xx"] - expected)[late].max() / expected[late].max()
        print(f"stress_xx of {expected[late].max():.3g} Pa is read to {error:.2g}")
        self.assertLess(error, 0.02)
        self.assertTrue((p["coordination_number"][whole] == 6).all())
        np.testing.assert_array_equal(p["step"], self.history["step"])

    def test_stress_of_particles_is_zero_at_the_start_and_then_tension_along_the_pull(self):
        first, second = self.frames[0], self.frames[1]
        self.assertEqual(np.abs(first["particles/stress"]).max(), 0.0)
        stress = second["particles/stress"]
        self.assertEqual(stress.shape, (COLUMNS * ROWS, 3))
        self.assertGreater(stress[:, 0].mean(), 5 * abs(stress[:, 1].mean()))

    def test_the_coordination_number_counts_bonds_at_the_start(self):
        bonds = len(held(self.frames[0]))
        self.assertAlmostEqual(summary(self.run_folder)["coordination_number"]["value"],
                               2 * bonds / (COLUMNS * ROWS))


class LostParticles(KerfTest):
    def refused_run(self, *arguments):
        result = self.kerf("run", self.write_case(PULLED_APART), "--out", self.folder / "run",
                           *arguments)
        print(result.stderr)
        self.assertEqual(result.returncode, 3, result.stdout + result.stderr)
        return result.stderr

    def test_a_particle_that_leaves_the_domain_ends_the_run_with_its_id(self):
        errors = self.refused_run(
            "--set", "participants.rock.domain=[[-1.0, -1.0], [13.51e-3, 1.0]]")
        self.assertRegex(errors, r"particle (27|55|83|111) has left the domain at t = \S+ s "
                                 r"\(step \d+\): it is at \(0\.0135\d+, \S+\) m")

    def test_a_number_that_is_lost_ends_the_run_before_a_frame_has_it(self):
        unstable = {"case.time_step": 1e-5, "case.allow_unstable": "true", "case.end_time": 1e-2,
                    "participants.rock.material.tensile_strength": 1e300,
                    "participants.rock.material.shear_strength": 1e300}
        errors = self.refused_run(*(a for k, v in unstable.items() for a in ("--set", f"{k}={v}")))
        self.assertRegex(errors, r"particle \d+ has no finite position or velocity any more at t = "
                                 r"\S+ s \(step \d+\)")
        for frame in frames(self.folder / "run"):
            self.assertTrue(np.isfinite(frame["particles/position"]).all())

    def test_particles_on_top_of_each_other_are_refused_with_their_ids(self):
        packing = self.folder / "packing.txt"
        packing.write_text("0.0 0.0 0.5e-3\n1e-3 0.0 0.5e-3\n2e-3 0.0 0.5e-3\n1.1e-3 0.0 0.5e-3\n")
        case = self.write_case("""
[case]
name = "heap"
dimension = 2
end_time = 1e-6
[participants.rock]
kind = "dem"
particles.file = "packing.txt"
material = { density = 2600.0, normal_stiffness = 1e10, tangential_stiffness = 2e9 }
""")
        result = self.kerf("check", case)
        print(result.stderr)
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, r"particles (1 and 3|3 and 1)")


if __name__ == "__main__":
    unittest.main()
