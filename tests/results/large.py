"""A million particles: what a user of a large model relies on, and what it costs."""

import json
import os
import resource
import sys
import time
import unittest

import h5py
import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import KerfTest

EDGE = 63  # cubes of four spheres
CASE = f"""[case]
name = "large"
dimension = 3
end_time = 1e-6
time_step = 5e-8

[case.output]
frames = 1
history = 4
checkpoints = 2

[participants.rock]
kind = "dem"
particles.lattice = {{ type = "fcc", spacing = 1e-3, origin = [0.0, 0.0, 0.0], count = [{EDGE}, {EDGE}, {EDGE}] }}
material = {{ density = 2600.0, normal_stiffness = 1e7, tangential_stiffness = 2e6 }}
gravity = [0.0, 0.0, -9.81]

[[participants.rock.boundary]]
box = [[-1.0, -1.0, -1.0], [1.0, 1.0, 1e-4]]
motion = "fixed"
"""
GIB = 2**30


class Million(KerfTest):
    def test_particles_are_built_stepped_written_and_restarted(self):
        case, count = self.write_case(CASE), 4 * EDGE**3
        begin = time.monotonic()
        run = self.run_case(case, timeout=900)
        seconds = time.monotonic() - begin
        peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss * 1024
        about = json.loads((run / "run.json").read_text())
        print(f"{count} particles, {about['steps']} steps in {seconds:.1f} s; "
              f"{peak / count:.0f} bytes a particle at most, "
              f"{about['participants']['rock']['memory_estimate'] / count:.0f} of large arrays")
        self.assertLess(peak, 4 * GIB)
        with h5py.File(run / "frames" / f"rock_{about['steps']:09}.h5") as frame:
            z = frame["particles/displacement"][:, 2]
            self.assertEqual(len(z), count)
            # All but the lowest layers fall freely: the sound has not come there. v^0 is zero.
            t = about["steps"] * about["time_step"]
            np.testing.assert_allclose(z[frame["particles/position"][:, 2] > 0.06], -0.5 * 9.81 * t * t, rtol=1e-9)
        end = (run / "history" / "rock.csv").read_bytes()

        middle = sorted((run / "checkpoints").iterdir())[0].name
        begin = time.monotonic()
        result = self.kerf("run", case, "--restart", f"{run}@{int(middle)}", "--out", self.folder / "again", timeout=900)
        print(f"again from step {int(middle)} in {time.monotonic() - begin:.1f} s")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual((self.folder / "again" / "history" / "rock.csv").read_bytes(), end)


if __name__ == "__main__":
    unittest.main()
