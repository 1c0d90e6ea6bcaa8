"""Bodies of elements as a user describes them: every law, plane, weight and damping, and what their
results hold. One element whose corners all move as prescribed has the same strain everywhere."""

import json
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

E, NU = 4e10, 0.2  # Pa
LAMBDA, MU = E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU))  # Pa
ELASTIC = f"density = 2600.0, young_modulus = {E}, poisson_ratio = {NU}"
SIDE = 0.1  # m
END = 1e-3  # s


def stretched(material, strain, plane="strain", shape=None):
    """A case: a square or a cube whose sides move so that its strains grow evenly to these."""
    dim = len(strain)
    sides = ["left", "right", "bottom", "top", "back", "front"][:2 * dim]
    motions = ""
    for k, side in enumerate(sides):
        velocity = [0.0] * dim
        velocity[k // 2] = k % 2 * strain[k // 2] * SIDE / END
        motions += (f'[[participants.body.boundary]]\ntag = "{side}"\ncomponents = ["{"xyz"[k // 2]}"]\n'
                    f'motion = "velocity"\nvelocity = {velocity}\n')
    return f"""[case]
name = "stretched"
dimension = {dim}
end_time = {END}
output = {{ frames = 1, history = 10 }}

[participants.body]
kind = "fem"
{f'plane = "{plane}"' if dim == 2 else ""}
mesh = {{ origin = {[0.0] * dim}, size = {[SIDE] * dim}, count = {[1] * dim}{
    f', shape = "{shape}"' if shape else ""} }}
material = {{ {material} }}

{motions}
[[measures]]
name = "energy_balance_error"
"""


def record(run):
    return json.loads((run / "run.json").read_text())


def end_of(run):
    """The time of the last frame, s: a whole number of steps."""
    return record(run)["steps"] * record(run)["time_step"]


class Solids(KerfTest):
    def last_frame(self, case, out="run"):
        """-> fields of the grid of the last frame; share of the strain that its stress knows"""
        run = self.run_case(self.write_case(case), out=out)
        with h5py.File(sorted((run / "frames").glob("body_*.h5"))[-1]) as file:
            (grid,) = [g for g in file.values() if isinstance(g, h5py.Group)]
            frame = {name: data[:] for name, data in grid.items()}
        self.assertAlmostEqual(end_of(run) / END, 1.0, delta=1e-14)
        steps = record(run)["steps"]
        # Incremental laws have followed the strain of the last forces, one step before the frame.
        return frame, (steps - 1) / steps

    def assert_stress(self, frame, expected, scale):
        """Round-off of some hundred increments, as a share of the scale."""
        for name in ("stress", "stress_at_nodes"):
            for stress in frame[name]:
                np.testing.assert_allclose(stress, expected, rtol=0, atol=1e-11 * scale, err_msg=name)

    def test_linear_elastic_in_plane_stress(self):
        frame, _ = self.last_frame(stretched(ELASTIC, [1e-3, -NU * 1e-3], "stress"))
        self.assert_stress(frame, [E * 1e-3, 0.0, 0.0, 0.0], E * 1e-3)  # uniaxial stress: E eps

    def test_linear_elastic_in_plane_strain(self):
        frame, _ = self.last_frame(stretched(ELASTIC, [1e-3, 0.0]))
        self.assert_stress(frame, [(LAMBDA + 2 * MU) * 1e-3, LAMBDA * 1e-3, LAMBDA * 1e-3, 0.0], E * 1e-3)

    def test_linear_elastic_in_axisymmetry(self):
        # u_r = eps r: the strain around the axis is eps, too
        frame, _ = self.last_frame(stretched(ELASTIC, [1e-3, 0.0], "axisymmetric"))
        self.assert_stress(frame, [2 * (LAMBDA + MU) * 1e-3, 2 * LAMBDA * 1e-3, 2 * (LAMBDA + MU) * 1e-3, 0.0], E * 1e-3)

    def test_transversely_isotropic(self):
        # The compliance of the layers, normal to y, whose inverse is the stiffness
        young = {"p": 4e10, "n": 2e10}
        nu_p, nu_pn = 0.2, 0.15
        compliance = np.array([[1 / young["p"], -nu_pn / young["p"], -nu_p / young["p"]],
                               [-nu_pn / young["p"], 1 / young["n"], -nu_pn / young["p"]],
                               [-nu_p / young["p"], -nu_pn / young["p"], 1 / young["p"]]])
        frame, _ = self.last_frame(stretched(
            'model = "transversely_isotropic", density = 2600.0, young_in_plane = 4e10, '
            "young_normal = 2e10, poisson_in_plane = 0.2, poisson_normal = 0.15, "
            "shear_normal = 1e10, axis = [0.0, 2.0, 0.0]", [1e-3, 5e-4]))
        stress = np.linalg.solve(compliance, [1e-3, 5e-4, 0.0])
        self.assert_stress(frame, [*stress, 0.0], 1e-3 * young["p"])

    def test_neo_hookean(self):
        # tau = mu (b - 1) + lambda ln J
        frame, _ = self.last_frame(stretched(f'model = "neo_hookean", {ELASTIC}', [0.2, -0.1]))
        J = 1.2 * 0.9
        self.assert_stress(frame, [(MU * (1.2**2 - 1) + LAMBDA * math.log(J)) / J,
                                   (MU * (0.9**2 - 1) + LAMBDA * math.log(J)) / J, LAMBDA * math.log(J) / J, 0.0], E * 0.2)

    def test_j2_plastic(self):
        # Without a change of volume q = 3 mu (e - p) = sigma_0 + H p with e = 2/sqrt(3) eps
        yield_stress, H, eps = 1e8, 5e9, 0.02
        frame, share = self.last_frame(stretched(
            f'model = "j2_plastic", {ELASTIC}, yield_stress = {yield_stress}, '
            f"hardening_modulus = {H}", [eps, -eps]))
        p = (3 * MU * 2 / math.sqrt(3) * eps * share - yield_stress) / (3 * MU + H)
        shear = (yield_stress + H * p) / math.sqrt(3)
        self.assert_stress(frame, [shear, -shear, 0.0, 0.0], yield_stress)
        self.assertAlmostEqual(frame["equivalent_plastic_strain"][0], p, delta=1e-11 * p)

    def test_drucker_prager(self):
        # Without dilation p = K tr(eps); the cone is sqrt(J2) = xi c - eta p, and uniaxial strain
        # has sqrt(J2) = sqrt(3)/2 |s_xx|
        c, phi, eps = 5e6, math.radians(20.0), -1e-2
        frame, share = self.last_frame(stretched(
            f'model = "drucker_prager", {ELASTIC}, cohesion = {c}, friction_angle = 20.0',
            [eps, 0.0, 0.0]))
        below = math.sqrt(3) * (3 - math.sin(phi))
        p = (LAMBDA + 2 / 3 * MU) * eps * share
        s = -2 / math.sqrt(3) * (6 * math.cos(phi) / below * c - 6 * math.sin(phi) / below * p)
        self.assert_stress(frame, [p + s, p - s / 2, p - s / 2, 0.0, 0.0, 0.0], abs(p))

    def test_isotropic_damage(self):
        # Uniaxial stress falls as f_t exp(-(eps - k_0) / k_s), k_s = G_f / (f_t h) - k_0 / 2
        f_t, G_f, eps = 4e6, 100.0, 5e-4
        frame, share = self.last_frame(stretched(
            f'model = "isotropic_damage", {ELASTIC}, tensile_strength = {f_t}, '
            f"fracture_energy = {G_f}", [eps, -NU * eps], "stress"))
        k_0 = f_t / E
        stress = f_t * math.exp(-(eps * share - k_0) / (G_f / (f_t * SIDE) - k_0 / 2))
        self.assert_stress(frame, [stress, 0.0, 0.0, 0.0], f_t)
        self.assertAlmostEqual(frame["damage"][0], 1 - stress / (E * eps * share), delta=1e-11)

    def test_finite_strain_has_the_logarithm_of_the_stretch(self):
        # The rate of strain on the current configuration adds up to ln(1 + u/L) by the midpoint
        # rule: a relative error of (deps)^2 / 12, 1e-6 for the 30 or more steps of 0.1
        frame, share = self.last_frame(stretched(f"{ELASTIC}, finite_strain = true", [0.1, 0.0]))
        stress = (LAMBDA + 2 * MU) * math.log(1 + 0.1 * share)
        self.assertAlmostEqual(frame["stress"][0, 0] / stress, 1.0, delta=2e-6)

    def test_every_shape_and_formulation_has_the_same_homogeneous_stress(self):
        plane = [(LAMBDA + 2 * MU) * 1e-3, LAMBDA * 1e-3, LAMBDA * 1e-3, 0.0]
        space = [*plane, 0.0, 0.0]
        for shape, formulation, expected in (
                ("tri3", "full", plane), ("quad4", "mean_dilatation", plane),
                ("quad4", "one_point", plane), ("tet4", "full", space),
                ("hex8", "mean_dilatation", space), ("hex8", "one_point", space)):
            strain = [1e-3] + [0.0] * (1 if expected is plane else 2)
            with self.subTest(shape=shape, formulation=formulation):
                frame, _ = self.last_frame(
                    stretched(f'{ELASTIC}, formulation = "{formulation}"', strain, shape=shape),
                    out=f"{shape}_{formulation}")
                self.assert_stress(frame, expected, E * 1e-3)


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
        self.assertEqual(columns, ["step", "time"] + named[:-1] + ["momentum_x", "momentum_y"])

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
        run = self.run_case(self.write_case(STRETCHED_ROW))
        self.assert_index_is_good(run / "row.xdmf", {"Quadrilateral", "Triangle"})
        frame = self.frame(run, "row")
        hard, soft = E * 1e-3, E / 4 * 1e-3  # eps = 1000/s 1e-6 s, nu = 0
        np.testing.assert_allclose(frame["mesh_quad4/stress"][:, 0], hard, rtol=1e-9)
        np.testing.assert_allclose(frame["mesh_tri3/stress"][:, 0], soft, rtol=1e-9)
        x = frame["mesh_quad4/position"][:, 0]
        for k, stress, inside in ((0, hard, x < 2.5e-3), (1, soft, x > 1.5e-3)):
            field = frame[f"mesh_quad4/stress_at_nodes_{k}"]
            np.testing.assert_allclose(field[:, 0], np.where(inside, stress, 0.0), rtol=1e-9)


if __name__ == "__main__":
    unittest.main()
