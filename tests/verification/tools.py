"""Cases with rigid tools, as a user runs them: results, errors, the same bits."""

import csv
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import KerfTest

# A square lattice on a floor; a blade from a file, in millimetres, comes down with a servo.
CASE = """[case]
name = "press"
dimension = 2
end_time = 1e-3

[case.output]
frames = 2
history = 50

[participants.rock]
kind = "dem"
threads = 1
particles.lattice = { type = "square", spacing = 1e-3, origin = [0.5e-3, 0.5e-3], count = [8, 6] }
material = { density = 2600.0, normal_stiffness = 1e10, tangential_stiffness = 2e9 }
damping = { translation = 0.5, rotation = 0.5 }
gravity = [0.0, -9.81]

[[participants.rock.tools]]
name = "floor"
shape = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]
normal_stiffness = 1e10
tangential_stiffness = 2e9
friction = 0.5

[[participants.rock.tools]]
name = "blade"
shape = "file"
file = "blade.txt"
scale = 1e-3
normal_stiffness = 1e10
tangential_stiffness = 2e9
servo = { direction = [0.0, -1.0], force = 1e4, max_velocity = 0.05 }

[[measures]]
name = "energy_balance_error"
expect = { max = 1e-3 }
"""
BLADE = "-2 6.001\n10 6.001\n10 9\n-2 9\n-2 6.001\n"
WEIGHT = 48 * 2600.0 * math.pi * 0.5e-3**2 * 9.81  # N per metre


def history(folder, name):
    """Columns of a history by name."""
    with open(folder / "history" / (name + ".csv")) as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {key: [float(row[key]) for row in rows] for key in rows[0]}


class Tools(KerfTest):
    def setUp(self):
        super().setUp()
        (self.folder / "blade.txt").write_text(BLADE)

    def test_a_servo_presses_with_its_force_and_the_floor_carries_it_with_the_weight(self):
        run = self.run_case(self.write_case(CASE))
        blade, floor = history(run, "rock_blade"), history(run, "rock_floor")
        print("force on blade %.6f N, on floor %.6f N" % (blade["force_y"][-1], floor["force_y"][-1]))
        self.assertAlmostEqual(blade["force_y"][-1], 1e4, delta=1.0)  # the particles push it up
        self.assertAlmostEqual(floor["force_y"][-1], -1e4 - WEIGHT, delta=2.0)
        self.assertEqual(blade["contacts"][-1], 8)
        self.assertGreater(blade["work"][-1], 0.0)

    def test_frames_show_the_surfaces_of_tools(self):
        index = (self.run_case(self.write_case(CASE)) / "rock.xdmf").read_text()
        self.assertIn("tool_blade/position", index)
        self.assertNotIn("tool_floor", index)  # a plane has no end

    def test_histories_have_the_same_bits_for_any_number_of_threads(self):
        case = self.write_case(CASE)
        one = self.run_case(case, out="one")
        two = self.run_case(case, "--set", "participants.rock.threads=2", out="two")
        for name in ("rock", "rock_blade", "rock_floor"):
            self.assertEqual((one / "history" / (name + ".csv")).read_bytes(),
                             (two / "history" / (name + ".csv")).read_bytes())

    def assert_refused(self, old, new, part, *parts):
        """Replaces a piece of the case; expects an error at the first line with a part of it."""
        self.assertEqual(CASE.count(old), 1)
        text = CASE.replace(old, new)
        line = text[:text.index(part)].count("\n") + 1
        result = self.kerf("check", self.write_case(text))
        print(result.stderr.replace(str(self.folder), "…"))
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertIn(f"case.toml:{line}: ", result.stderr)
        self.assertIn("\n  Fix: ", result.stderr)
        for expected in parts:
            self.assertIn(expected, result.stderr)

    def test_faults_are_told_with_their_key_and_a_fix(self):
        tools = "participants.rock.tools"
        self.assert_refused("normal = [0.0, 1.0]\n", "", "[[participants.rock.tools]]",
                            tools + "[0].normal is missing")
        self.assert_refused('normal = [0.0, 1.0]', "normal = [0.0, 0.0]", "normal = [0.0, 0.0]",
                            tools + "[0].normal", "not zero")
        self.assert_refused('file = "blade.txt"', 'file = "knife.txt"', "knife.txt", "knife.txt")
        self.assert_refused("[participants.rock]", "[participants.rock_floor]\nkind = \"dem\"\n"
                            "particles.file = \"blade.txt\"\nmaterial = { density = 1.0, normal_stiffness = 1.0,"
                            " tangential_stiffness = 1.0 }\n[participants.rock]", 'name = "floor"',
                            "history/rock_floor.csv would be of")
        self.assert_refused("max_velocity = 0.05 }", 
                            'max_velocity = 0.05 }\nfree = { axes = ["y"], mass = 1.0 }',
                            '[[participants.rock.tools]]\nname = "blade"', tools + "[1]", "cannot be free along it")
        self.assert_refused("friction = 0.5", "friction = 0.5\nvelocities = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]]",
                            "velocities", tools + "[0].velocities", "times ascending")
        self.assert_refused("friction = 0.5", "rotation = { axis = [0.0, 1.0] }", "rotation = { axis",
                            tools + "[0].rotation.axis", "turns in the plane")

    def test_a_surface_that_is_none_is_told_with_its_file_and_line(self):
        (self.folder / "blade.txt").write_text("0 0\n1 one\n")
        self.assert_refused("scale = 1e-3", "scale = 1.0", "file = ", "participants.rock.tools[1].file",
                            "blade.txt:2")


if __name__ == "__main__":
    unittest.main()
