"""The page of verifications is the report of the tests: what must be noticed."""

import json
import os
import pathlib
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import table

ROW = dict(test="Hertz.force", file="tests/verification/dem_hertz.cpp", what="force",
           source="Hertz (1881)", error=2.34e-6, tolerance=1e-5, reason="steps")


class Table(unittest.TestCase):
    def reports(self, *rows, name="Hertz.force"):
        with tempfile.TemporaryDirectory() as folder:
            lines = "".join(json.dumps(row) + "\n" for row in rows)
            pathlib.Path(folder, name + ".jsonl").write_text(lines)
            return table.read_reports(folder)

    def differences(self, reported, committed=ROW, tests=("Hertz.force",)):
        page = table.read_page(table.render(self.reports(committed)["Hertz.force"]))
        return table.differences(page, reported, tests)

    def test_the_same_rows_are_accepted_whatever_their_errors(self):
        self.assertEqual(self.differences(self.reports({**ROW, "error": 9e-6})), [])

    def test_another_text_or_tolerance_is_noticed(self):
        for change in (dict(what="energy"), dict(source="Mindlin (1949)"), dict(tolerance=2e-5),
                       dict(reason="rounding")):
            self.assertEqual(len(self.differences(self.reports({**ROW, **change}))), 2, change)

    def test_a_row_that_is_new_or_gone_is_noticed(self):
        self.assertEqual(len(self.differences(self.reports(ROW, {**ROW, "what": "time"}))), 1)
        self.assertEqual(len(self.differences(self.reports())), 1)
        self.assertEqual(len(self.differences({}, tests=())), 1)  # the test is gone
        self.assertEqual(self.differences({}), [])  # the test has not run

    def test_of_several_errors_the_largest_counts_and_what_is_no_number_most(self):
        largest = self.reports({**ROW, "error": 1e-7}, ROW, {**ROW, "error": 1e-9})
        self.assertEqual([row["error"] for row in largest["Hertz.force"]], ["2e-6"])
        lost = self.reports({**ROW, "error": None}, ROW)
        self.assertEqual(lost["Hertz.force"][0]["error"], "inf")


if __name__ == "__main__":
    unittest.main()
