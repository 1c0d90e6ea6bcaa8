"""What a user finds in the results of bodies of elements, and reads of their cases."""

import math
import os
import re
import sys
import unittest
from xml.etree import ElementTree

import h5py
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import ROOT, KerfTest
from stretched import E, ELASTIC, SIDE, end_of, record, stretched


def free_bodies(density="2600.0"):
    """Three equal bodies that fall: freely, with damping by mass, with local damping."""
    text = ""
    for name, damping in (("free", ""), ("mass", "damping = { mass = 400.0 }"),
                          ("local", "damping = { local = 0.25 }")):
        text += f"""
[participants.{name}]
kind = "fem"
mesh = {{ origin = [0.0, 0.0], size = [{SIDE}, {SIDE}], count = [2, 3] }}
material = {{ {ELASTIC} }}
gravity = [0.0, -9.81]
{damping}
"""
    return f"""[case]
name = "fall"
dimension = 2
end_time = 5e-3
output = {{ frames = 1, history = 10 }}
{text}
[[measures]]
name = "energy_balance_error"
expect = {{ max = 1e-9 }}
"""


# Two quads and two triangles in a row along x, in millimetres; the triangles are another group.
MIXED = """$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 1 "hard"
2 2 "soft"
$EndPhysicalNames
$Nodes
8
1 0 0 0
2 1 0 0
3 2 0 0
4 3 0 0
5 0 1 0
6 1 1 0
7 2 1 0
8 3 1 0
$EndNodes
$Elements
4
1 3 2 1 1 1 2 6 5
2 3 2 1 1 2 3 7 6
3 2 2 2 2 3 4 8
4 2 2 2 2 3 8 7
$EndElements
"""
STRETCHED_ROW = f"""[case]
name = "row"
dimension = 2
end_time = 1e-6
output = {{ frames = 1, history = 10 }}

[participants.row]
kind = "fem"
mesh = {{ type = "file", file = "row.msh", scale = 1e-3 }}

[[participants.row.materials]]
region = "hard"
density = 2600.0
young_modulus = {E}
poisson_ratio = 0.0

[[participants.row.materials]]
region = "soft"
density = 2600.0
young_modulus = {E / 4}
poisson_ratio = 0.0
""" + "".join(f"""
[[participants.row.boundary]]
box = [[{k}e-3, 0.0], [{k}e-3, 1e-3]]
motion = "velocity"
velocity = [{k}.0, 0.0]
""" for k in range(4))  # u = 1000/s t x, whatever the material


class Reading(KerfTest):
    def frame(self, run, name):
        with h5py.File(sorted((run / "frames").glob(f"{name}_*.h5"))[-1]) as file:
            return {f"{grid}/{key}": data[:] for grid, group in file.items()
                    if isinstance(group, h5py.Group) for key, data in group.items()}

    def assert_index_is_good(self, index, cells):
        """Every item is there with the size that the index says, and cells name its points."""
        found = set()
        for grid in ElementTree.parse(index).iter("Grid"):
            topology = grid.find("Topology")
            if topology is None:
                continue
            found.add(topology.get("TopologyType"))
            arrays = {}
            for item in grid.iter("DataItem"):
                if item.get("Format") != "HDF":
                    continue
                file, name = item.text.strip().split(":")
                with h5py.File(index.parent / file) as frame:
                    arrays[name] = frame[name][:]
                self.assertEqual(list(map(int, item.get("Dimensions").split())),
                                 list(arrays[name].shape), name)
            points = next(a for n, a in arrays.items() if n.endswith("/position"))
            corners = next(a for n, a in arrays.items() if n.endswith("/cells"))
            self.assertEqual(int(topology.get("NumberOfElements")), len(corners))
            self.assertLess(corners.max(), len(points))
        self.assertEqual(found, cells)


class Results(Reading):
    def test_bodies_fall_by_their_weight_and_damping_holds_them_back(self):
        run = self.run_case(self.write_case(free_bodies()))
        t, dt, g = end_of(run), record(run)["time_step"], 9.81
        # Central differences are exact for a constant acceleration, which local damping leaves but
        # in the half step from rest, when there is no motion that it could oppose. Damping by mass
        # has v = g/a (1 - exp(-a t)), to the order (a dt)^2
        expected = {"free": 0.5 * g * t**2, "local": 0.75 * 0.5 * g * t**2 + 0.25 * g * dt / 2 * t,
                    "mass": g / 400.0 * (t - (1 - math.exp(-400.0 * t)) / 400.0)}
        for name, fall in expected.items():
            u = self.frame(run, name)["mesh/displacement"]
            np.testing.assert_allclose(u[:, 1], -fall, rtol=1e-4 if name == "mass" else 1e-9)
            np.testing.assert_allclose(u[:, 0], 0.0, atol=1e-12 * fall)

    def test_the_index_finds_every_data_set_of_every_shape(self):
        for dim, shape, cells in ((2, "tri3", "Triangle"), (2, "quad4", "Quadrilateral"),
                                  (3, "tet4", "Tetrahedron"), (3, "hex8", "Hexahedron")):
            with self.subTest(shape=shape):
                run = self.run_case(self.write_case(stretched(ELASTIC, [1e-3] * dim, shape=shape)),
                                    out=shape)
                self.assert_index_is_good(run / "body.xdmf", {cells})

    def test_columns_of_the_history_are_those_of_the_user_guide(self):
        run = self.run_case(self.write_case(stretched(ELASTIC, [1e-3, 0.0])))
        with open(run / "history" / "body.csv") as file:
            file.readline()
            columns = file.readline().strip().split(",")
        guide = (ROOT / "docs" / "user_guide.md").read_text()
        (line,) = [line for line in guide.splitlines() if line.startswith("| FEM | `kinetic_energy`")]
        named = re.findall(r"`(\w+)`", line)
        self.assertEqual(named[-2:], ["momentum_x", "stage"])  # the last one with stages only
        self.assertEqual(columns, ["step", "time"] + named[:-2] + ["momentum_x", "momentum_y"])

    def test_a_mesh_in_millimetres_is_doubted_in_the_log_and_on_the_terminal(self):
        case = self.write_case(stretched(ELASTIC, [1e-3, 0.0]).replace(
            f"size = [{SIDE}, {SIDE}]", "size = [100.0, 100.0]"))
        for verb in (["check", case], ["run", case, "--out", self.folder / "run"]):
            result = self.kerf(*verb)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertRegex(result.stderr, r"^warning: participants\.body: in the whole run a wave "
                                            r"travels 4\.\d* m, less than the shortest edge")
        self.assertIn("warning: in the whole run", (self.folder / "run/logs/body.log").read_text())

    def test_an_error_of_a_material_names_its_key_and_line(self):
        case = self.write_case(stretched(
            f'model = "isotropic_damage", {ELASTIC}, tensile_strength = 1e7, '
            "fracture_energy = 1.0", [1e-3, 0.0]))
        result = self.kerf("run", case, "--out", self.folder / "run")
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("case.toml:11: participants.body.material.fracture_energy: 1 J/m² is too "
                      "little for an element of length 0.1 m", result.stderr)


class MixedMesh(Reading):
    def test_a_mixed_mesh_has_a_grid_for_each_shape_and_nodal_stress_for_each_material(self):
        (self.folder / "row.msh").write_text(MIXED)
        case = self.write_case(STRETCHED_ROW)
        planned = self.kerf("check", case)
        self.assertEqual(planned.returncode, 0, planned.stderr)
        self.assertIn("4 elements", planned.stdout)
        run = self.run_case(case)
        self.assert_index_is_good(run / "row.xdmf", {"Quadrilateral", "Triangle"})
        frame = self.frame(run, "row")
        hard, soft = E * 1e-3, E / 4 * 1e-3  # eps = 1000/s 1e-6 s, nu = 0
        np.testing.assert_allclose(frame["mesh_quad4/stress"][:, 0], hard, rtol=1e-9)
        np.testing.assert_allclose(frame["mesh_tri3/stress"][:, 0], soft, rtol=1e-9)
        x = frame["mesh_quad4/position"][:, 0]
        for k, stress, inside in ((0, hard, x < 2.5e-3), (1, soft, x > 1.5e-3)):
            field = frame[f"mesh_quad4/stress_at_nodes_{k}"]
            np.testing.assert_allclose(field[:, 0], np.where(inside, stress, 0.0), rtol=1e-9)


K_N, K_T = 1e10, 2e9  # N/m per metre of thickness
SPACING = 1e-3  # m


def beside_a_packing(particles):
    """A triangular lattice, and a square of elements of its stiffness that is stretched along x."""
    return f"""[case]
name = "beside"
dimension = 2
end_time = 1e-6
output = {{ frames = 1, history = 10 }}

[participants.rock]
kind = "dem"
particles = {{ {particles} }}
material = {{ density = 2600.0, normal_stiffness = {K_N}, tangential_stiffness = {K_T} }}

[participants.far]
kind = "fem"
mesh = {{ origin = [0.0, 0.0], size = [1.0, 1.0], count = [1, 1] }}
material = {{ model = "from_packing", participant = "rock" }}

[[participants.far.boundary]]
tag = "left"
motion = "fixed"

[[participants.far.boundary]]
tag = "right"
motion = "velocity"
velocity = [1.0, 0.0]
"""


class FromPacking(Reading):
    def assert_is_triangular_lattice(self, particles, tolerance):
        """C11 = sqrt(3)/4 (3 k_n + k_t), C12 = sqrt(3)/4 (k_n - k_t), fraction pi / (2 sqrt(3))."""
        run = self.run_case(self.write_case(beside_a_packing(particles)))
        frame = self.frame(run, "far")
        stress = frame["mesh/stress"][0] / end_of(run)  # eps = t / s
        np.testing.assert_allclose(stress[:2], [math.sqrt(3) / 4 * (3 * K_N + K_T),
                                                math.sqrt(3) / 4 * (K_N - K_T)], rtol=tolerance)
        np.testing.assert_allclose(frame["mesh/mass"].sum(), 2600.0 * math.pi / 2 / math.sqrt(3),
                                   rtol=tolerance)

    def test_a_lattice_has_the_closed_form(self):
        self.assert_is_triangular_lattice(
            f'lattice = {{ type = "triangular", spacing = {SPACING}, origin = [0.0, 0.0], '
            "count = [4, 4] }", 1e-12)

    def test_a_packing_has_what_is_measured_on_it(self):
        # A lattice in a file: the measurement solves for equilibrium to 1e-8 or better
        (self.folder / "lattice.txt").write_text("".join(
            f"{SPACING * (i + 0.5 * (j % 2))!r} {SPACING * math.sqrt(0.75) * j!r} {SPACING / 2}\n"
            for j in range(12) for i in range(12)))
        self.assert_is_triangular_lattice('file = "lattice.txt"', 1e-7)


if __name__ == "__main__":
    unittest.main()
