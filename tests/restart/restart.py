"""A run that goes on from a checkpoint has the bits of one that was never stopped."""

import filecmp
import json
import os
import shutil
import signal
import sys
import time
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import CONFIGS, PROGRAMS, KerfTest, Run, wait_until_gone

# A bonded block on a floor under its weight, cut by a blade that a servo presses down: bonds break,
# grains slide, the list of contacts is made again, tools of every kind move.
BLOCK_2D = """
[case]
name = "block"
dimension = 2
end_time = 1.2e-3
output = { frames = 12, history = 150, checkpoints = 6, keep_checkpoints = 100 }

[participants.rock]
kind = "dem"
threads = 1
particles.lattice = { type = "triangular", spacing = 1e-3, origin = [0.0, 0.5e-3], count = [30, 14] }
material = { density = 2600.0, normal_stiffness = 1e9, tangential_stiffness = 2e8, \
tensile_strength = 1.5e3, shear_strength = 1.5e3, friction = 0.5 }
damping = { translation = 0.2, rotation = 0.2 }
gravity = [0.0, -9.81]
boundary = [{ box = [[-1e-4, -1.0], [6e-4, 4e-3]], motion = "fixed" }]
loads = [{ box = [[10e-3, 9e-3], [16e-3, 12e-3]], forces = [[0.0, 0.0, 0.0], [1e-3, 0.0, -20.0]] }]
clusters = [{ box = [[25.9e-3, 7e-3], [28.1e-3, 10.1e-3]] }]
probes = [{ name = "middle", box = [[8e-3, 3e-3], [20e-3, 8e-3]] }]

[[participants.rock.tools]]
name = "floor"
shape = "plane"
point = [0.0, 0.0]
normal = [0.0, 1.0]
normal_stiffness = 1e9
tangential_stiffness = 2e8
friction = 0.5

[[participants.rock.tools]]
name = "blade"
shape = "box"
box = [[30.2e-3, 8e-3], [34e-3, 16e-3]]
velocity = [-4.0, 0.0]
normal_stiffness = 2e9
tangential_stiffness = 4e8
friction = 0.3

[[participants.rock.tools]]
name = "plate"
shape = "box"
box = [[2e-3, 12.5e-3], [8e-3, 14e-3]]
normal_stiffness = 1e9
tangential_stiffness = 2e8
servo = { direction = [0.0, -1.0], force = 2e3, max_velocity = 0.5 }

[[participants.rock.tools]]
name = "wheel"
shape = "box"
box = [[12e-3, 12.7e-3], [15e-3, 15.7e-3]]
normal_stiffness = 1e9
tangential_stiffness = 2e8
friction = 0.5
velocity = [1.0, -0.4]
free = { axes = ["y"], mass = 0.05, force = [0.0, -200.0] }
free_rotation = { inertia = 1e-6 }
"""

# The same in space, with bonds that bend, dashpots and rolling resistance.
BLOCK_3D = """
[case]
name = "block"
dimension = 3
end_time = 3e-4
output = { frames = 6, history = 80, checkpoints = 4, keep_checkpoints = 100 }

[participants.rock]
kind = "dem"
threads = 1
particles.lattice = { type = "cubic", spacing = 1e-3, origin = [0.0, 0.0, 0.5e-3], count = [12, 6, 6] }
material = { density = 2600.0, normal_stiffness = 1e6, tangential_stiffness = 2e5, friction = 0.5, \
tensile_strength = 2.0, shear_strength = 2.0, bond_radius_ratio = 0.8, rolling_friction = 0.1, \
restitution = 0.8 }
damping = { translation = 0.1, rotation = 0.1 }
gravity = [0.0, 0.0, -9.81]

[[participants.rock.clusters]]
box = [[0.9e-3, 0.9e-3, 3e-3], [3.1e-3, 3.1e-3, 4e-3]]

[[participants.rock.clusters]]
box = [[8.9e-3, -0.1e-3, 5e-3], [11.1e-3, 1.1e-3, 6e-3]]
motion = "prescribed"
velocity = [0.1, 0.0, 0.0]
rotation = { axis = [0.0, 1.0, 0.0], rate = 50.0 }

[[participants.rock.tools]]
name = "floor"
shape = "plane"
point = [0.0, 0.0, 0.0]
normal = [0.0, 0.0, 1.0]
normal_stiffness = 1e6
tangential_stiffness = 2e5
friction = 0.5

[[participants.rock.tools]]
name = "drill"
shape = "box"
box = [[4.6e-3, 1.1e-3, 6.1e-3], [7.4e-3, 3.9e-3, 9e-3]]
velocity = [0.0, 0.0, -6.0]
rotation = { axis = [0.0, 0.0, 1.0], rate = 2000.0 }
normal_stiffness = 2e6
tangential_stiffness = 4e5
friction = 0.4
"""

BAR = """
[case]
name = "bar"
dimension = {dimension}
end_time = 2e-5
output = {{ frames = 10, history = 60, checkpoints = 5, keep_checkpoints = 100 }}

[participants.bar]
kind = "fem"
threads = 1
mesh = {{ origin = {origin}, size = {size}, count = {count} }}
material = {{ density = 2358.0, young_modulus = 1.2e10, poisson_ratio = 0.2 }}
boundary = [{{ tag = "left", motion = "hann", amplitude = {amplitude}, duration = 8e-6 }},
            {{ tag = "right", motion = "fixed" }}]

[[measures]]
name = "energy_balance_error"
"""
BAR_2D = BAR.format(dimension=2, origin=[0.0, 0.0], size=[0.06, 0.01], count=[60, 10],
                    amplitude=[1e-8, 2e-9])
BAR_3D = BAR.format(dimension=3, origin=[0.0] * 3, size=[0.03, 5e-3, 4e-3], count=[30, 5, 4],
                    amplitude=[1e-8, 2e-9, 0.0])


def steps_of(folder):
    return sorted(int(p.parent.name) for p in folder.glob("checkpoints/*/checkpoint.json"))


def results(folder):
    found = [p for part in ("history", "frames") for p in (folder / part).rglob("*")]
    return sorted(str(p.relative_to(folder)) for p in found + list(folder.glob("*.xdmf")))


class RestartTest(KerfTest):
    model = "a run that was killed or extended"

    def assert_same_results(self, a, b):
        """Histories, frames and index byte by byte; the summary but for the wall time."""
        self.assertEqual(results(a), results(b))
        self.assertGreater(len(results(a)), 5)
        _, different, errors = filecmp.cmpfiles(a, b, results(a), shallow=False)
        print(different, errors)
        self.verify(f"{self.model}: histories and frames after a restart that differ in any byte",
                    "the run that was not interrupted", len(different) + len(errors), 0,
                    "a checkpoint holds all that steps have changed")
        summaries = [json.loads((f / "summary.json").read_text()) for f in (a, b)]
        for s in summaries:
            s.pop("wall_time", None)
        self.assertEqual(*summaries)

    def restart(self, case, source, *arguments, code=0):
        result = self.kerf("run", case, "--restart", source, *arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def kill_after_checkpoint(self, case, out, number, *arguments):
        """Kills kerf and its participants with signal 9 once some checkpoints are complete."""
        run = Run(self.folder / out, case, *arguments)
        children = run.children()
        deadline = time.monotonic() + 60
        while len(steps_of(run.folder)) < number:
            if run.process.poll() is not None or time.monotonic() > deadline:
                raise AssertionError("it ended too soon: " + run.process.communicate()[1])
            time.sleep(0.002)
        for pid in [run.process.pid, *children.values()]:
            os.kill(pid, signal.SIGKILL)
        run.process.communicate()
        self.assertIsNotNone(wait_until_gone(children.values(), 5.0))
        self.assertFalse((run.folder / "summary.json").exists())
        return run.folder


class Restart(RestartTest):
    def assert_every_restart_has_the_bits(self, text):
        case = self.write_case(text)
        whole = self.run_case(case, out="whole")
        steps = steps_of(whole)
        self.assertGreaterEqual(len(steps), 4)
        for step in steps[:-1]:
            with self.subTest(step=step):
                again = self.folder / f"from_{step}"
                self.restart(case, f"{whole}@{step}", "--out", again)
                self.assert_same_results(whole, again)
                self.assertEqual(steps_of(again), [s for s in steps if s > step])
                for later in steps_of(again):  # checkpoints themselves, too
                    name = f"checkpoints/{later:09}"
                    for file in (whole / name).rglob("*.h5"):
                        other = again / file.relative_to(whole)
                        self.assertEqual(file.read_bytes(), other.read_bytes(), str(file))
        return whole

    def test_a_block_of_discs_that_tools_break(self):
        self.model = "discs that tools break"
        whole = self.assert_every_restart_has_the_bits(BLOCK_2D)
        cracks = (whole / "history/rock_cracks.csv").read_text().count("\n") - 2
        summary = json.loads((whole / "run.json").read_text())["participants"]["rock"]["summary"]
        print(f"{cracks} cracks, {summary['contact_list_renewals']} renewals")
        self.assertGreater(cracks, 50)
        self.assertGreater(summary["contact_list_renewals"], 2)

    def test_a_block_of_spheres_that_a_tool_drills(self):
        self.model = "spheres that a tool drills"
        whole = self.assert_every_restart_has_the_bits(BLOCK_3D)
        cracks = (whole / "history/rock_cracks.csv").read_text().count("\n") - 2
        print(f"{cracks} cracks")
        self.assertGreater(cracks, 50)

    def test_elements_in_the_plane(self):
        self.model = "elements in the plane"
        self.assert_every_restart_has_the_bits(BAR_2D)

    def test_elements_in_space(self):
        self.model = "elements in space"
        self.assert_every_restart_has_the_bits(BAR_3D)

    def test_with_more_threads(self):
        self.model = "with another number of threads"
        case = self.write_case(BLOCK_2D)
        whole = self.run_case(case, out="whole")
        self.restart(case, f"{whole}@{steps_of(whole)[1]}", "--out", self.folder / "again",
                     "--set", "participants.rock.threads=2")
        self.assert_same_results(whole, self.folder / "again")

    def test_a_coupled_case(self):
        self.model = "a coupled case"
        case = CONFIGS / "wave_bar.toml"
        more = ("--set", "case.output.checkpoints=5", "--set", "case.output.keep_checkpoints=9")
        for method in ("lagrange", "penalty"):
            with self.subTest(method=method):
                chosen = more + ("--set", f"couplings.joint.method={method}",
                                 "--set", "measures.constraint_violation.expect.max=1.0",
                                 "--set", "measures.reflected_energy.expect.max=1.0")
                whole = self.run_case(case, *chosen, out=method)
                again = self.folder / f"{method}_again"
                self.restart(case, f"{whole}@{steps_of(whole)[2]}", "--out", again, *chosen)
                self.assert_same_results(whole, again)


class Killed(RestartTest):
    LONGER = ("--set", "case.end_time=8e-3", "--set", "case.output.checkpoints=40",
              "--set", "case.output.frames=80", "--set", "case.output.history=4000")

    def test_a_killed_run_goes_on_in_its_own_folder_to_the_same_bits(self):
        case = self.write_case(BLOCK_2D)
        whole = self.run_case(case, *self.LONGER, out="whole")
        killed = self.kill_after_checkpoint(case, "killed", 7, *self.LONGER)
        last = steps_of(killed)[-1]
        history = (killed / "history/rock.csv").read_text().splitlines()
        print(f"killed after step {history[-1].split(',')[0]}, goes on from {last}")
        self.restart(case, killed, *self.LONGER)
        self.assert_same_results(whole, killed)

    def test_a_killed_coupled_run_goes_on_to_the_same_bits(self):
        case = CONFIGS / "wave_bar.toml"
        more = ("--set", "case.output.checkpoints=30", "--set", "case.end_time=6e-5",
                "--set", "measures.reflected_energy.expect.max=1.0")
        whole = self.run_case(case, *more, out="whole")
        killed = self.kill_after_checkpoint(case, "killed", 2, *more)
        self.restart(case, killed, *more)
        self.assert_same_results(whole, killed)

    def end_by(self, number):
        case = self.write_case(BLOCK_2D)
        whole = self.run_case(case, *self.LONGER, out="whole")
        none = self.LONGER + ("--set", "case.output.checkpoints=0")
        run = self.start(case, *none, out="ended")
        os.kill(run.process.pid, number)
        code, errors, seconds = run.end(timeout=20)
        print(f"signal {number}: {seconds:.2f} s: {errors.strip()}")
        self.assertEqual(len(errors.strip().splitlines()), 1)
        steps = steps_of(run.folder)
        self.assertEqual(len(steps), 1)
        self.assertRegex(errors, rf"at step {steps[0]} of \d+; .* Go on from step {steps[0]} with "
                                 rf"--restart {run.folder}\.")
        self.restart(case, run.folder, *none)
        self.assert_same_results(whole, run.folder)
        return code

    def test_ctrl_c_leaves_a_checkpoint_of_the_step_that_it_came_in(self):
        self.assertEqual(self.end_by(signal.SIGINT), 130)

    def test_sigterm_leaves_a_checkpoint_too(self):
        self.assertEqual(self.end_by(signal.SIGTERM), 143)


class Refused(RestartTest):
    def setUp(self):
        super().setUp()
        self.case = self.write_case(BAR_2D)
        self.whole = self.run_case(self.case, out="whole")
        self.steps = steps_of(self.whole)

    def refusal(self, source, *arguments, case=None):
        before = {p: p.read_bytes() for p in self.whole.rglob("*") if p.is_file()}
        result = self.restart(case or self.case, source, *arguments, code=2)
        for path in ("history/bar.csv", "bar.xdmf", "checkpoints/%09d/bar.h5" % self.steps[-1]):
            self.assertEqual((self.whole / path).read_bytes(), before[self.whole / path], path)
        print(result.stderr.strip())
        return result.stderr

    def test_a_truncated_file(self):
        file = self.whole / ("checkpoints/%09d/bar.h5" % self.steps[1])
        for size in (0, 100, file.stat().st_size // 2, file.stat().st_size - 8):
            content = file.read_bytes()
            file.write_bytes(content[:size])
            self.assertRegex(self.refusal(f"{self.whole}@{self.steps[1]}"),
                             r"bar\.h5 is truncated, changed or no checkpoint")
            file.write_bytes(content)

    def test_a_changed_bit(self):
        file = self.whole / ("checkpoints/%09d/bar.h5" % self.steps[1])
        content = bytearray(file.read_bytes())
        import h5py
        with h5py.File(file) as f:
            at = f["state/velocity.row"].id.get_offset() + 8 * 77
        content[at] ^= 1
        file.write_bytes(content)
        self.assertRegex(self.refusal(f"{self.whole}@{self.steps[1]}"), "truncated, changed")

    def test_a_cut_record(self):
        file = self.whole / ("checkpoints/%09d/checkpoint.json" % self.steps[-1])
        file.write_text(file.read_text()[:300])
        self.assertRegex(self.refusal(self.whole), r"checkpoint\.json is truncated")

    def test_another_case_with_the_keys_that_differ(self):
        errors = self.refusal(self.whole, "--set", "participants.bar.material.density=2000.0",
                              "--set", "case.output.history=61")
        self.assertIn("participants.bar.material.density is 2000.0 and was 2358.0", errors)
        self.assertIn("case.output.history is 61 and was 60", errors)

    def test_another_version(self):
        file = self.whole / ("checkpoints/%09d/checkpoint.json" % self.steps[-1])
        record = json.loads(file.read_text())
        record["kerf"] = "99.1"
        file.write_text(json.dumps(record))
        self.assertRegex(self.refusal(self.whole), r'written by kerf "99\.1", and this is "')

    def test_the_file_of_another_model(self):
        other = self.run_case(self.case, "--set", "participants.bar.mesh.count=[61, 10]",
                              "--set", "case.time_step=1e-8", "--set", "case.allow_unstable=true",
                              out="other")
        shutil.copy(other / ("checkpoints/%09d/bar.h5" % steps_of(other)[0]),
                    self.whole / ("checkpoints/%09d/bar.h5" % self.steps[0]))
        self.assertRegex(self.refusal(f"{self.whole}@{self.steps[0]}"), "it has another mesh")

    def test_a_step_or_a_folder_without_checkpoint(self):
        self.assertRegex(self.refusal(f"{self.whole}@7"), r"no checkpoint of step 7")
        self.assertRegex(self.refusal(self.folder / "nowhere"), r"has no checkpoints")
        self.assertRegex(self.refusal(f"{self.whole}@last"), r'"last" is not the number of a step')

    def test_an_end_before_the_checkpoint(self):
        self.assertRegex(self.refusal(self.whole, "--set", "case.end_time=1e-6"),
                         r"case\.end_time: the run ends at t = \S+ s, which is not after")

    def test_checkpoints_of_a_program_that_has_none(self):
        case = self.write_case("""
[case]
name = "masses"
dimension = 2
end_time = 1e-6
time_step = 1e-8
output.checkpoints = 2
[participants.masses]
kind = "dem"
command = ["%s", "--points", "4", "--dimension", "2"]
particles.lattice = { type = "chain", spacing = 1e-3, origin = [0.0, 0.0], count = [4, 1] }
material = { density = 2600.0, normal_stiffness = 1e10, tangential_stiffness = 0.0 }
""" % (PROGRAMS / "kerf-echo"), name="echo.toml")
        result = self.kerf("run", case, "--out", self.folder / "echo")
        print(result.stderr.strip())
        self.assertEqual(result.returncode, 2)
        self.assertIn('participant "masses" (kerf-echo) cannot write checkpoints', result.stderr)


class Extended(RestartTest):
    def test_a_run_goes_on_beyond_its_end(self):
        case = self.write_case(BAR_2D)
        step = ("--set", "case.time_step=8e-8")
        run = self.run_case(case, *step)
        last = steps_of(run)[-1]
        self.assertEqual(last, 250)
        self.restart(case, run, *step, "--set", "case.end_time=3e-5")
        rows = (run / "history/bar.csv").read_text().splitlines()
        self.assertEqual(int(rows[-1].split(",")[0]), 374)

    def test_only_the_newest_checkpoints_are_kept(self):
        run = self.run_case(self.write_case(BAR_2D), "--set", "case.output.keep_checkpoints=2")
        self.assertEqual(len(list((run / "checkpoints").iterdir())), 2)
        self.assertEqual(len(steps_of(run)), 2)


if __name__ == "__main__":
    unittest.main()
