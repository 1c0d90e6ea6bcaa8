"""Cases that cannot be used: exit code 2, the line, the key, and the fix."""

import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import KerfTest

GOOD = """[case]
name = "joint"
dimension = 2
end_time = 1e-6

[participants.rock]
kind = "dem"
particles.lattice = { type = "square", spacing = 1e-3, origin = [-9.5e-3, 0.5e-3], count = [12, 4] }
material = { density = 2600.0, normal_stiffness = 1e10, tangential_stiffness = 2e9 }

[participants.far]
kind = "fem"
mesh = { type = "box", origin = [0.0, 0.0], size = [10e-3, 4e-3], count = [10, 4] }
material = { density = 2000.0, young_modulus = 1e10, poisson_ratio = 0.0 }
boundary = [{ tag = "right", motion = "fixed" }]

[[couplings]]
name = "joint"
type = "overlap"
between = ["rock", "far"]
boundary = "left"
width = 2e-3
method = "lagrange"
"""


class BrokenCases(KerfTest):
    def assert_refused(self, old, new, line, *parts, command="check"):
        """Replaces a piece of the good case; expects the error at that line with those parts."""
        self.assertEqual(GOOD.count(old), 1)
        case = self.write_case(GOOD.replace(old, new))
        result = self.kerf(command, case)
        print(result.stderr.replace(str(self.folder), "…"))
        self.assertEqual(result.returncode, 2, result.stdout + result.stderr)
        self.assertIn(f"{case}:{line}: ", result.stderr)
        self.assertIn("\n  Fix: ", result.stderr)
        for part in parts:
            self.assertIn(part, result.stderr)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()),
                         ["case.toml"] if command == "check" else sorted(["case.toml", "results"]))

    def test_the_good_case_is_good(self):
        case = self.write_case(GOOD)
        result = self.kerf("check", case)
        self.assertEqual(result.returncode, 0, result.stderr)
        for part in ("48 particles", "55 nodes, 40 elements", "couples 8 particles with 15 nodes",
                     "time step"):
            self.assertIn(part, result.stdout)

    def test_a_probe_cannot_have_the_file_of_the_cracks(self):
        line = "tangential_stiffness = 2e9 }\n"
        self.assert_refused(line, line + 'probes = [{ name = "cracks", '
                            "box = [[0.0, 0.0], [1.0, 1.0]] }]\n", 10,
                            'two time series of participants.rock are named "cracks"')

    def test_a_probe_cannot_have_the_file_of_a_coupling(self):
        line = "tangential_stiffness = 2e9 }\n"
        case = self.write_case(GOOD.replace(line, line + 'probes = [{ name = "joint", '
                                            "box = [[0.0, 0.0], [1.0, 1.0]] }]\n")
                               .replace('[[couplings]]\nname = "joint"',
                                        '[[couplings]]\nname = "rock_joint"'))
        result = self.kerf("check", case)
        self.assertEqual(result.returncode, 2)
        self.assertIn('would have the same file as "rock_joint"', result.stderr)

    def test_a_missing_key_is_named_with_its_table(self):
        self.assert_refused("end_time = 1e-6\n", "", 1, "case.end_time", "missing")

    def test_a_wrong_type_is_named_with_what_was_found(self):
        self.assert_refused("width = 2e-3", 'width = "wide"', 22, "couplings", "width", "wide", "number")

    def test_an_unknown_key_is_answered_with_the_nearest_one(self):
        self.assert_refused("density = 2600.0", "densty = 2600.0", 9, "densty", "density")

    def test_a_negative_radius_is_refused(self):
        self.assert_refused("material = { density = 2600.0",
                            "particles.radius = -1e-3\nmaterial = { density = 2600.0", 9,
                            "participants.rock.particles.radius", "-0.001")

    def test_particles_without_size_or_mass_are_refused(self):
        self.assert_refused("material = { density = 2600.0",
                            "particles.radius = 0.0\nmaterial = { density = 2600.0", 9,
                            "participants.rock.particles.radius = 0", "greater than 0")
        self.assert_refused("density = 2600.0", "density = 0.0", 9,
                            "participants.rock.material.density = 0", "greater than 0")
        (self.folder / "stones.txt").write_text("0.0 0.0 1e-3\n5e-3 0.0 0.0\n")
        lattice = GOOD[GOOD.index("particles.lattice"):GOOD.index("\nmaterial = { density = 2600")]
        result = self.kerf("check", self.write_case(GOOD.replace(lattice, 'particles.file = "stones.txt"')))
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn("stones.txt:2: the radius 0 m must be positive", result.stderr)

    def test_a_missing_file_is_named(self):
        lattice = GOOD[GOOD.index("particles.lattice"):GOOD.index("\nmaterial = { density = 2600")]
        self.assert_refused(lattice, 'particles.file = "stones.txt"', 8, "stones.txt")

    def test_an_unknown_tag_is_answered_with_the_tags_of_the_mesh(self):
        self.assert_refused('tag = "right"', 'tag = "rihgt"', 15, "rihgt", "right")

    def test_an_unknown_overlap_boundary_is_answered_with_those_of_the_mesh(self):
        self.assert_refused('boundary = "left"', 'boundary = "lfet"', 21, "lfet", "left")

    def test_two_participants_of_one_name_are_refused(self):
        self.assert_refused("[participants.far]", "[participants.rock]", 11, "rock")

    def test_bodies_that_do_not_overlap_are_refused(self):
        self.assert_refused("origin = [-9.5e-3, 0.5e-3]", "origin = [-99.5e-3, 0.5e-3]", 20, "overlap")

    def test_particles_beyond_the_width_are_refused(self):
        self.assert_refused("count = [12, 4]", "count = [14, 4]", 22, "beyond the width")

    def test_a_step_above_the_critical_one_is_refused_with_both(self):
        self.assert_refused("end_time = 1e-6", "end_time = 1e-6\ntime_step = 1e-3", 5, "0.001",
                            "critical", command="check")

    def test_a_coupling_to_an_unknown_participant_is_answered_with_the_nearest_one(self):
        self.assert_refused('between = ["rock", "far"]', 'between = ["rokc", "far"]', 20, "rokc", "rock")

    def test_a_measure_that_cannot_be_taken_is_refused_before_the_run(self):
        measure = '\n[[measures]]\nname = "reflected_energy"\n'
        case = self.write_case(GOOD + measure)
        result = self.kerf("check", case)
        self.assertEqual(result.returncode, 2)
        self.assertIn("measures[0].participant is missing", result.stderr)
        case = self.write_case(GOOD + measure + 'participant = "far"\nreference = "rock"\n')
        result = self.kerf("check", case)
        self.assertEqual(result.returncode, 2)
        self.assertIn("one of the two is a mesh", result.stderr)

    def test_a_run_of_a_broken_case_leaves_earlier_results_alone(self):
        case = self.write_case(GOOD)
        folder = self.run_case(case)
        before = {p: p.read_bytes() for p in folder.rglob("*") if p.is_file()}
        self.write_case(GOOD.replace("density = 2600.0", "density = -1.0"))
        self.assertEqual(self.kerf("run", case, "--out", folder).returncode, 2)
        self.assertEqual(before, {p: p.read_bytes() for p in folder.rglob("*") if p.is_file()})

    def test_a_folder_with_other_files_is_not_overwritten(self):
        case = self.write_case(GOOD)
        (self.folder / "mine").mkdir()
        (self.folder / "mine" / "thesis.txt").write_text("years of work")
        result = self.kerf("run", case, "--out", self.folder / "mine")
        self.assertEqual(result.returncode, 2)
        self.assertIn("not a run of kerf", result.stderr)


if __name__ == "__main__":
    unittest.main()
