"""Every law of elements as a user writes it. One element whose corners all move as prescribed has the
same strain everywhere."""

import math
import os
import sys
import unittest

import h5py
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import KerfTest
from stretched import E, ELASTIC, END, LAMBDA, MU, NU, SIDE, end_of, record, stretched


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
        # rule: a relative error of (deps)^2 / 12, 1e-6 for the 30 or more steps of 0.1. It gives
        # Kirchhoff's stress, 1 + u/L times that of Cauchy.
        frame, share = self.last_frame(stretched(f"{ELASTIC}, finite_strain = true", [0.1, 0.0]))
        stretch = 1 + 0.1 * share
        stress = (LAMBDA + 2 * MU) * math.log(stretch) / stretch
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


if __name__ == "__main__":
    unittest.main()
