"""What happens when a part of a run dies: everybody else is gone within a second, the user reads
one sentence, and nothing is left behind."""

import os
import re
import signal
import sys
import time
import unittest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from kerf_process import CONFIGS, KerfTest, is_alive, left_by, wait_until_gone

LONG = ("--set", "case.end_time=10.0",  # hours of steps: it ends when the test ends it
        "--set", "case.output.history=1000000", "--set", "case.output.frames=20000")


class Fault(KerfTest):
    transport = "shm"

    def setUp(self):
        super().setUp()
        self.run_ = self.start(CONFIGS / "wave_bar.toml", "--transport", self.transport, *LONG)
        self.participants = self.run_.children()
        self.addCleanup(self.kill_everything)
        self.assertEqual(set(self.participants), {"rock", "far", "whole"})
        self.assertTrue(left_by(self.run_.process.pid))  # its socket: there is something to see

    def kill_everything(self):
        for pid in [self.run_.process.pid, *self.participants.values()]:
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass

    def assert_nothing_left(self):
        self.assertEqual(left_by(self.run_.process.pid), [])
        self.assertEqual([p for p in self.run_.folder.rglob("*") if p.suffix in (".part", ".tmp")], [])

    def assert_killed_participant_is_named(self, name):
        pid = self.participants[name]
        os.kill(pid, signal.SIGKILL)
        start = time.monotonic()
        code, errors, _ = self.run_.end(timeout=10)
        self.assertIsNotNone(wait_until_gone(self.participants.values(), 1.0))
        seconds = time.monotonic() - start
        print(f"kill -9 of {name} over {self.transport}: {seconds:.2f} s: {errors.strip()}")
        self.assertEqual(code, 3, errors)
        self.assertLess(seconds, 1.0)
        self.assertRegex(errors, rf'participant "{name}" \(pid {pid}\) was killed by signal 9 '
                                 r"\(Killed\) at (about )?step \d+ of \d+")
        self.assertIn(f"logs/{name}.log", errors)
        self.assertEqual(len(errors.strip().splitlines()), 1)
        self.assert_nothing_left()

    def test_a_killed_particle_program_ends_the_run(self):
        self.assert_killed_participant_is_named("rock")

    def test_a_killed_element_program_ends_the_run(self):
        self.assert_killed_participant_is_named("far")

    def test_a_killed_program_without_coupling_ends_the_run(self):
        self.assert_killed_participant_is_named("whole")

    def test_participants_end_with_a_killed_kerf_and_say_why(self):
        os.kill(self.run_.process.pid, signal.SIGKILL)
        self.run_.process.wait()
        seconds = wait_until_gone(self.participants.values(), 2.0)
        print(f"kill -9 of kerf over {self.transport}: participants gone after {seconds} s")
        self.assertIsNotNone(seconds)
        self.assertLess(seconds, 1.0)
        for name in self.participants:
            log = (self.run_.folder / "logs" / f"{name}.log").read_text()
            self.assertRegex(log, rf"the broker \(pid {self.run_.process.pid}\) is gone at step \d+")
        self.run_.process.stderr.close()
        self.run_.process.stdout.close()
        self.assert_nothing_left()

    def end_by(self, number):
        os.kill(self.run_.process.pid, number)
        start = time.monotonic()
        code, errors, _ = self.run_.end(timeout=10)
        self.assertIsNotNone(wait_until_gone(self.participants.values(), 1.0))
        seconds = time.monotonic() - start
        print(f"signal {number} to kerf over {self.transport}: {seconds:.2f} s: {errors.strip()}")
        self.assertLess(seconds, 1.0)
        self.assertEqual(len(errors.strip().splitlines()), 1)
        self.assert_nothing_left()
        return code, errors

    def test_ctrl_c_ends_the_run_in_order(self):
        code, errors = self.end_by(signal.SIGINT)
        self.assertEqual(code, 130)
        self.assertRegex(errors, r"ended by Ctrl-C at step \d+ of \d+")

    def test_sigterm_ends_the_run_in_order(self):
        code, errors = self.end_by(signal.SIGTERM)
        self.assertEqual(code, 143)
        self.assertRegex(errors, r"ended by signal 15 at step \d+ of \d+")


class FaultOverZeroMq(Fault):
    transport = "zmq"


class Hang(KerfTest):
    def test_a_stopped_participant_is_named_after_the_hang_limit(self):
        run = self.start(CONFIGS / "wave_bar.toml", *LONG, "--set", "case.hang_limit=1.0")
        participants = run.children()
        os.kill(participants["far"], signal.SIGSTOP)
        try:
            code, errors, seconds = run.end(timeout=10)
        finally:
            for pid in participants.values():
                if is_alive(pid):
                    os.kill(pid, signal.SIGKILL)
        print(f"SIGSTOP of far: {seconds:.2f} s: {errors.strip()}")
        self.assertEqual(code, 3)
        self.assertLess(seconds, 1.0 + 1.0)
        self.assertRegex(errors, rf'participant "far" \(pid {participants["far"]}\) was silent for 1 s'
                                 r" at step \d+ of \d+")


if __name__ == "__main__":
    unittest.main()
