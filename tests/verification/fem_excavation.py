"""The tunnel of configs/excavation.toml against the closed form."""

import os
import sys
import unittest

TESTS = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
sys.path[:0] = [TESTS, os.path.join(TESTS, "results")]
from kerf_process import CONFIGS, summary
from actions import Actions


class Excavation(Actions):
    def test_the_wall_of_a_tunnel_moves_as_kirsch_has_it(self):
        run = self.run_case(CONFIGS / "excavation.toml")
        last = {name: {key: values[-1] for key, values in self.table(run, "rock_" + name).items()}
                for name in ("crown", "invert", "left_wall", "right_wall")}
        end, body = summary(run)["end"], self.table(run, "rock")
        self.assertEqual(end["by"], "at_rest")
        self.assertEqual(end["conditions"][0]["value"],
                         body["kinetic_energy"][-1] / abs(body["elastic_energy"][-1]))
        E, nu, a = 2e10, 0.25, 2.5
        p_v = 2600.0 * 9.81 * 200.0
        p_h = 0.5 * p_v
        mean, half = (p_v + p_h) / 2, (p_v - p_h) / 2
        # Inward; what the stress grows over the tunnel cancels in the closure of opposite points
        vertical = a * (1 + nu) / E * (mean + half * (3 - 4 * nu))
        horizontal = a * (1 + nu) / E * (mean - half * (3 - 4 * nu))
        closure = {
            "vertical": ((last["invert"]["displacement_y"] - last["crown"]["displacement_y"]) / 2,
                         vertical),
            "horizontal": ((last["left_wall"]["displacement_x"]
                            - last["right_wall"]["displacement_x"]) / 2, horizontal)}
        for name, (found, exact) in closure.items():
            self.verify(f"tunnel dug in stressed rock: {name} closure of the wall",
                        "Kirsch, Z. VDI 42 (1898) 797-807, plane strain, less the displacement "
                        "before the hole", (found - exact) / vertical, 0.02,
                        "of the vertical one; rollers at 20 radii hold back about (1/20)² of each, "
                        "80 quad4 around the wall, and what is left of the motion at rest")


if __name__ == "__main__":
    unittest.main()
