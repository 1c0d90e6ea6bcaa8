"""Elements of every shape against FEniCSx on the same mesh with the same scheme."""

import json
import os
import subprocess
import sys
import unittest

import numpy as np

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import PROGRAMS, KerfTest

HERE = os.path.dirname(os.path.abspath(__file__))


def name_of(run):
    words = [run["shape"], run["law"], "finite strain" if run["finite_strain"] else "",
             {"strain": "plane strain" if run["dimension"] == 2 else "", "stress": "plane stress",
              "axisymmetric": "axisymmetric"}[run["plane"]],
             {"full": "", "mean_dilatation": "mean dilatation",
              "one_point": "one point, no hourglass control"}[run["formulation"]]]
    return ", ".join(word for word in words if word)


class Elements(KerfTest):
    # FEniCSx 0.5.2; a distorted body with an initial velocity of 5 % of the speed of sound, one side
    # of it moved, 200 steps at half of the critical one. The discretisation is the same: what
    # differs is the order of sums: some 1e-14 after 200 steps.
    def compare(self, shape):
        environment = {**os.environ, "OMP_NUM_THREADS": "1"}
        ours = subprocess.run([PROGRAMS / "fem_run", shape], capture_output=True, text=True,
                              timeout=60, env=environment)
        self.assertEqual(ours.returncode, 0, ours.stderr)
        (self.folder / "runs.json").write_text(ours.stdout)
        theirs = subprocess.run(["/usr/bin/python3", os.path.join(HERE, "fenicsx_elements.py"),
                                 self.folder / "runs.json", self.folder / "output.npz"],
                                stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=500,
                                env=environment)
        self.assertEqual(theirs.returncode, 0, theirs.stdout + theirs.stderr)
        output = np.load(self.folder / "output.npz")
        for k, run in enumerate(json.loads(ours.stdout)):
            with self.subTest(name_of(run)):
                reference = output[f"displacement_{k}"]
                if run["law"] == "j2":  # or the law was not looked at
                    self.assertGreater(output[f"flowed_{k}"], 0.5)
                kerf = np.array(run["displacement"]).reshape(reference.shape)
                self.verify(f"motion of a distorted body: {name_of(run)}", "FEniCSx 0.5.2",
                            np.abs(kerf - reference).max() / np.abs(reference).max(), 1e-11,
                            "order of sums")

    def test_triangles_move_as_in_fenicsx(self):
        self.compare("tri3")

    def test_quadrilaterals_move_as_in_fenicsx(self):
        self.compare("quad4")

    def test_tetrahedra_move_as_in_fenicsx(self):
        self.compare("tet4")

    def test_hexahedra_move_as_in_fenicsx(self):
        self.compare("hex8")


if __name__ == "__main__":
    unittest.main()
