"""Starts the program kerf for a test and looks at what it leaves behind."""

import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "verification"))
from report import report

CONFIGS = ROOT / "configs"
PROGRAMS = pathlib.Path(os.environ["KERF_PROGRAMS"])  # folder of kerf, kerf-dem, kerf-fem


class KerfTest(unittest.TestCase):
    """A test with a folder of its own that is gone afterwards."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="kerf-test-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write_case(self, text, name="case.toml"):
        path = self.folder / name
        path.write_text(text)
        return path

    def kerf(self, *arguments, timeout=120):
        """Runs kerf to its end. -> CompletedProcess with text output"""
        return subprocess.run([PROGRAMS / "kerf", *map(str, arguments)], capture_output=True,
                              text=True, timeout=timeout, cwd=self.folder)

    def run_case(self, case, *arguments, out="run", code=0, timeout=120):
        """Runs a case; -> the run folder."""
        folder = self.folder / out
        result = self.kerf("run", case, "--out", folder, *arguments, timeout=timeout)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return folder

    def verify(self, what, source, error, tolerance, reason):
        """Expects |error| <= tolerance, and reports both for docs/verification.md."""
        file = pathlib.Path(sys.modules[type(self).__module__].__file__).resolve().relative_to(ROOT)
        report(file, what, source, error, tolerance, reason)
        print(f"{what}: {error:.2e} of {tolerance:g}")
        self.assertLessEqual(abs(error), tolerance, what)

    def start(self, case, *arguments, out="run"):
        """Starts a run and waits until its steps are under way. -> Run"""
        return Run(self.folder / out, case, *arguments)


class Run:
    """A run that is under way."""

    def __init__(self, folder, case, *arguments):
        self.folder = folder
        self.process = subprocess.Popen(
            [PROGRAMS / "kerf", "run", str(case), "--out", folder, *map(str, arguments)],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True)
        histories = folder / "history"
        deadline = time.monotonic() + 60
        while not any(p.stat().st_size > 500 for p in histories.glob("*.csv")):
            if self.process.poll() is not None or time.monotonic() > deadline:
                raise AssertionError("the run did not start: " + self.process.communicate()[1])
            time.sleep(0.02)

    def children(self):
        """pid of every participant by its program."""
        found = {}
        for entry in pathlib.Path("/proc").iterdir():
            if entry.name.isdigit():
                try:
                    status = (entry / "status").read_text()
                    environment = (entry / "environ").read_bytes()
                except OSError:
                    continue
                if re.search(rf"^PPid:\s+{self.process.pid}$", status, re.M):
                    name = re.search(rb"KERF_PARTICIPANT=([^\0]*)", environment)
                    if name:
                        found[name[1].decode()] = int(entry.name)
        return found

    def end(self, timeout):
        """Waits for kerf itself. -> (exit code, stderr, seconds)"""
        start = time.monotonic()
        _, errors = self.process.communicate(timeout=timeout)
        return self.process.returncode, errors, time.monotonic() - start


def is_alive(pid):
    """True for a process that runs; a zombie has ended."""
    try:
        status = pathlib.Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return False
    return not re.search(r"^State:\s+Z", status, re.M)


def wait_until_gone(pids, seconds):
    """Waits for processes that are not our children. -> seconds that it took, or None"""
    start = time.monotonic()
    while time.monotonic() - start < seconds:
        if not any(is_alive(pid) for pid in pids):
            return time.monotonic() - start
        time.sleep(0.005)
    return None


def summary(folder):
    return json.loads((folder / "summary.json").read_text())


def left_by(pid):
    """Names that could outlive the kerf of that pid: sockets and segments."""
    lines = pathlib.Path("/proc/net/unix").read_text().splitlines()
    names = [line.split()[-1] for line in lines]
    if os.path.isdir("/dev/shm"):
        names += [p.name for p in pathlib.Path("/dev/shm").iterdir()]
    return [name for name in names if f"kerf-{pid}-" in name]
