"""docs/verification.md from what the tests reported: table.py (--check | --write) REPORTS BUILD

REPORTS has a file of JSON lines of every test that ran, see verification.hpp; BUILD is the build folder,
whose ctest knows which tests there are. --check compares the page with the reports of all tests that
ran, but for the errors, which differ by machine."""

import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "verification.md"
INTRODUCTION = """# Verification

What the tests compare kerf with. Every row is reported by a test that fails when the error exceeds the
tolerance; a row of several comparisons has the largest error. The errors are those of one machine.

`ninja -C build/release verification` runs these tests and writes this page anew; see
[CONTRIBUTING](../CONTRIBUTING.md#verification).
"""
PARTS = (("Particles", r"tests/verification/(dem_|bodies)"), ("Elements", r"tests/verification/fem_"),
         ("Couplings", r"tests/verification/coupled_|configs/"),
         ("Restarts", r"tests/restart/"), ("Other codes", r"tests/reference/"))
HEAD = ("verified", "source", "error", "tolerance", "reason of the tolerance", "test")


def number(value, digits):
    """3e-6, 0.15: no more digits than given."""
    text = f"{value:.{digits}g}"
    return re.sub(r"e([+-])0*(\d+)", lambda m: "e" + m[1].strip("+") + m[2], text)


def read_reports(folder):
    """-> {test: [row]}, an empty list for a test that verified nothing; a row is a dict of texts."""
    reports = {}
    for path in sorted(pathlib.Path(folder).glob("*.jsonl")):
        rows = {}
        for entry in map(json.loads, path.read_text().splitlines()):
            key = (entry["what"], number(entry["tolerance"], 2))
            # What is not a number comes as null, and counts as the worst.
            error = float("inf") if entry["error"] is None else entry["error"]
            row = rows.setdefault(key, {**entry, "tolerance": key[1], "error": 0.0})
            row["error"] = max(row["error"], error)
        for row in rows.values():
            row["error"] = number(row["error"], 1)
            for text in (row["what"], row["source"], row["reason"]):
                if "|" in text or "\n" in text or not text:
                    sys.exit(f"{row['test']}: not for a table: '{text}'")
        tests = {row["test"] for row in rows.values()} or {path.stem.replace("%", "/")}
        for test in tests:
            reports[test] = [row for row in rows.values() if row["test"] == test]
    return reports


def part_of(file):
    for part, pattern in PARTS:
        if re.match(pattern, file):
            return part
    sys.exit(f"{file} belongs to no part of {PAGE.name}: see PARTS in {__file__}")


def render(rows):
    """-> the page; rows in the order of the tests."""
    text = INTRODUCTION
    for part, _ in PARTS:
        mine = [row for row in rows if part_of(row["file"]) == part]
        if mine:
            text += f"\n## {part}\n"
        for file in sorted({row["file"] for row in mine}):
            text += f"\n[{file}](../{file})\n\n| {' | '.join(HEAD)} |\n|{' --- |' * len(HEAD)}\n"
            for row in mine:
                if row["file"] == file:
                    text += (f"| {row['what']} | {row['source']} | {row['error']} | {row['tolerance']} "
                             f"| {row['reason']} | `{row['test']}` |\n")
    return text


def read_page(text):
    """-> rows of the page as render() was given them, without errors."""
    rows, file = [], None
    for line in text.splitlines():
        if link := re.match(r"\[((?:tests|configs)/\S+)\]", line):
            file = link[1]
        cells = [cell.strip() for cell in line.split("|")[1:-1]]
        if len(cells) == len(HEAD) and tuple(cells) != HEAD and cells[0] != "---":
            what, source, _, tolerance, reason, test = cells
            rows.append(dict(what=what, source=source, tolerance=tolerance, reason=reason,
                             test=test.strip("`"), file=file))
    return rows


def differences(page, reports, tests):
    """-> sentences; only of tests that ran, or that are none."""
    def said(row):
        return tuple(row[key] for key in ("test", "file", "what", "source", "tolerance", "reason"))

    committed = {said(row) for row in page}
    reported = {said(row) for rows in reports.values() for row in rows if row["test"] in tests}
    sentences = [f"not on the page: {', '.join(row)}" for row in sorted(reported - committed)]
    for row in sorted(committed - reported):
        if row[0] not in tests:
            sentences.append(f"on the page, of a test that does not exist: {', '.join(row)}")
        elif row[0] in reports:
            sentences.append(f"on the page, but not reported: {', '.join(row)}")
    return sentences


def tests_of(build):
    """-> names of all tests in their order"""
    result = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1"], check=True,
                            capture_output=True, text=True)
    # ctest calls a typed test Suite.name<Suite/type. …>, GoogleTest Suite/type.name. The tests of one
    # program have its name before theirs.
    names = [test["name"].removeprefix("fem_verification.")
             for test in json.loads(result.stdout)["tests"]]
    return [re.sub(r"^\w+\.(\w+)<(\w+/\w+)\..*>$", r"\2.\1", name) for name in names]


def main(mode, folder, build):
    tests = tests_of(build)
    unbuilt = [name for name in tests if name.endswith("_NOT_BUILT")]
    reports = read_reports(folder)
    page = read_page(PAGE.read_text()) if PAGE.exists() else []
    if mode == "--check":
        if unbuilt:  # then nobody knows their tests
            tests += [row["test"] for row in page]
        wrong = differences(page, reports, tests)
        if wrong:
            sys.exit("\n".join([*wrong, "", f"docs/{PAGE.name} is not what the tests report.",
                                "Fix: ninja -C build/release verification, and commit the page."]))
        ran = sum(1 for row in page if row["test"] in reports)
        print(f"{ran} of {len(page)} rows of docs/{PAGE.name} are those that the tests report; "
              "the other tests have not run here.")
    elif mode == "--write":
        missing = {row["test"] for row in page if unbuilt or row["test"] in tests} - set(reports)
        if missing:
            sys.exit(f"First run all of them: {', '.join(sorted(missing))} did not report.")
        rows = [row for test in tests for row in reports.get(test, [])]
        PAGE.write_text(render(rows))
        print(f"{PAGE}: {len(rows)} rows")


if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] not in ("--check", "--write"):
        sys.exit(__doc__)
    main(*sys.argv[1:])
