"""Runs a case whose expectations verify: expectations.py CASE OUT [SETTING…]

The case has the numbers; the sources and the reasons of the tolerances are here. Fails when kerf does,
which checks the expectations itself."""

import json
import os
import pathlib
import subprocess
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "verification"))
from report import report

CHAINS = "independent study of chains, docs/theory/coupling.md"
UNBLENDED = "R = 9 s² / (16 + 9 s²), s = sin k w"
# (case, measure) or measure: what, source, reason of the tolerance
CLAIMS = {
    ("wave_chain", "reflected_energy"):
        ("reflected energy of a pulse of 32 spacings", CHAINS,
         "what such an overlap reflects at best, and some room"),
    ("wave_chain.without_blending", "reflected_energy"):
        ("reflected energy without blending, less 0.17", UNBLENDED, "the pulse averages over k"),
    ("wave_bar", "reflected_energy"):
        ("reflected energy of a plane P wave, 2D", "the same lattice without an interface",
         "above the mesh floor of a perfect joint at 16 spacings a wave"),
    ("wave_block", "reflected_energy"):
        ("reflected energy of a plane P wave, 3D", "the same lattice without an interface",
         "elements of C11, not of the cubic lattice, and a short wave"),
    "energy_drift": ("drift of the energy", "central differences keep v M v / 2 + u K u / 2 of v "
                     "half a step before and after", "rounding of all steps"),
    "momentum_residual": ("momentum that the coupling makes", "Newton's third law",
                          "rounding of sums"),
    "energy_balance_error": ("energy that the books miss", "first law",
                             "nonlinear rotations of the lattice, of the size of the strain"),
    "constraint_violation": ("distance between particles and elements, m",
                             "Rojek (2008) multipliers, docs/theory/coupling.md",
                             "rounding of displacements over dt²"),
    "constraint_violation by penalty": ("slip of a penalty joint, m", "springs of the overlap",
                                        "no more than the amplitude of the pulse, 1e-6 m"),
}


def claim_of(name, measure, method):
    if measure == "constraint_violation" and method == "penalty":
        return CLAIMS["constraint_violation by penalty"]
    for key in ((name, measure), (name.split(".")[0], measure), measure):
        if key in CLAIMS:
            return CLAIMS[key]
    sys.exit(f"{measure} of {name} has no source in {__file__}")


def main(case, out, *settings):
    arguments = [word for setting in settings for word in ("--set", setting)]
    kerf = pathlib.Path(os.environ["KERF_PROGRAMS"]) / "kerf"
    code = subprocess.run([kerf, "run", case, "--out", out, *arguments]).returncode
    if code not in (0, 1):
        return code
    name = os.environ.get("KERF_TEST", pathlib.Path(case).stem).removeprefix("case.")
    ran = tomllib.loads(pathlib.Path(out, "case.toml").read_text())
    values = json.loads(pathlib.Path(out, "summary.json").read_text())
    for measure in ran["measures"]:
        expect = measure.get("expect")
        if not expect:
            continue
        what, source, reason = claim_of(name, measure["name"], ran["couplings"][0]["method"])
        least, most = expect.get("min", 0.0), expect["max"]
        middle = 0.5 * (least + most) if least > 0.0 else 0.0
        report(pathlib.Path(case).relative_to(ROOT), what, source,
               values[measure["name"]]["value"] - middle, most - middle, reason)
    return code


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
