"""Reports what a test in Python verifies, as verification.hpp does for GoogleTest."""

import json
import math
import os
import pathlib

_folder, _test = os.environ.get("KERF_VERIFICATION"), os.environ.get("KERF_TEST")
_lines = []


def _write():
    if _folder and _test:
        pathlib.Path(_folder).mkdir(parents=True, exist_ok=True)
        pathlib.Path(_folder, _test + ".jsonl").write_text("".join(_lines))


def report(file, what, source, error, tolerance, reason):
    """file is the path in the repository of what states the claim."""
    _lines.append(json.dumps(dict(
        test=_test, file=str(file), what=what, source=source, tolerance=float(tolerance),
        error=abs(float(error)) if math.isfinite(error) else None, reason=reason)) + "\n")
    _write()


_write()  # what an earlier run reported is over
