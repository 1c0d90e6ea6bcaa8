"""Packings in a case and on the command line."""

import os
import subprocess
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import PROGRAMS, KerfTest

CASE = """[case]
name = "pocket"
dimension = 2
seed = 3
end_time = 2e-6

[participants.rock]
kind = "dem"
material = { density = 2600.0, normal_stiffness = 1.6e10, tangential_stiffness = 3.2e9 }
bonds.coordination_number = 5.4

[participants.rock.particles.packing]
region.box = [[0.0, 0.0], [0.02, 0.02]]
radii = { law = "power", min = 0.262e-3, max = 0.653e-3, exponent = 3.56 }
porosity = 0.13
cut = { center = [0.01, 0.01], radius = 0.008 }
"""


class Packings(KerfTest):
    def setUp(self):
        super().setUp()
        os.environ["XDG_CACHE_HOME"] = str(self.folder / "cache")

    def particles(self, path):
        return [tuple(map(float, line.split())) for line in path.read_text().splitlines()
                if not line.startswith("#")]

    def test_a_case_makes_its_packing_once_and_leaves_it_in_the_run_folder(self):
        case = self.write_case(CASE)
        first = self.run_case(case) / "packings" / "rock.txt"
        kept = list((self.folder / "cache/kerf/packings").iterdir())
        self.assertEqual(len(kept), 1)
        self.assertGreater(len(self.particles(kept[0])), len(self.particles(first)))
        for x, y, _ in self.particles(first):
            self.assertLessEqual((x - 0.01) ** 2 + (y - 0.01) ** 2, 0.008 ** 2)
        again = self.run_case(first.parents[1] / "case.toml", out="again") / "packings" / "rock.txt"
        self.assertEqual(first.read_bytes(), again.read_bytes())
        self.assertEqual(list((self.folder / "cache/kerf/packings").iterdir()), kept)
        other = self.run_case(case, "--set", "case.seed=4", out="other") / "packings" / "rock.txt"
        self.assertNotEqual(self.particles(first), self.particles(other))

    def test_faults_of_a_packing_are_told_with_their_line(self):
        for old, new, line, part in (
                ("porosity = 0.13", "porosity = 1.3", 15, "porosity"),
                ("min = 0.262e-3, ", "", 14, "radii.min is missing"),
                ("region.box = [[0.0, 0.0], [0.02, 0.02]]", "region.radius = 1.0", 13, "center"),
                ("porosity = 0.13", "porosity = 0.13\ncount = 1\nseed = -1", 17, "seed"),
                ("bonds.c", "bonds.gap_tolerance = 0.1\nbonds.c", 11, "both"),
                ("coordination_number = 5.4", "coordination_number = 0.5", 10, "touch"),
                ("[[0.0, 0.0], [0.02, 0.02]]", "[[0.0, 0.0], [0.02, 1e-4]]", 12, "narrow")):
            with self.subTest(new):
                self.assertEqual(CASE.count(old), 1)
                result = self.kerf("check", self.write_case(CASE.replace(old, new)))
                self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
                self.assertIn(f"case.toml:{line}: ", result.stderr)
                self.assertIn(part, result.stderr)

    def test_pack_is_the_verb_of_kerf_dem_with_its_exit_code(self):
        made = self.kerf("pack", "--region", "disc:0,0,1", "--radii", "uniform:0.04,0.06", "--porosity",
                         "0.2", "--out", "disc.vtk")
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertIn("porosity              0.1995", made.stdout)
        self.assertEqual(self.kerf("pack", "--convert", "disc.vtk", "disc.txt").returncode, 0)
        for x, y, r in self.particles(self.folder / "disc.txt"):
            self.assertLess((x * x + y * y) ** 0.5 + r, 1 + 1e-6)
        measured = self.kerf("pack", "--from", "disc.txt", "--moduli", "--normal-stiffness", "1e9",
                             "--coordination-number", "5")
        self.assertIn("coordination number   5.0", measured.stdout)
        self.assertIn("C66", measured.stdout)
        wrong = self.kerf("pack", "--region", "ball:1", "--radii", "uniform:1,2", "--porosity", "0.2")
        self.assertEqual(wrong.returncode, 2)
        self.assertIn("ball:1 is not a region", wrong.stderr)
        direct = subprocess.run([PROGRAMS / "kerf-dem", "pack", "--from", "none"], capture_output=True)
        self.assertEqual(direct.returncode, 2)


if __name__ == "__main__":
    unittest.main()
