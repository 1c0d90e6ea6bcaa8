"""The body of elements that several tests share: one that is stretched evenly."""

import json

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
