#!/usr/bin/env python3
"""Prints times of `./dev test` as Markdown: seconds of the last run of each build step, and of the last tests,
by program and the slowest ones. Two steps or programs run at once, so wall time is about half of a sum.

    tests/times.py [BUILD_FOLDER]      build/release by default
"""

import json
import re
import sys
from collections import defaultdict
from pathlib import Path

BUILD = Path(sys.argv[1] if len(sys.argv) > 1 else 'build/release')
SLOWEST = 100


def build_steps(log):
    """Seconds by step from a log of ninja, which has a line per output: the last run of each command."""
    runs = {}
    for line in log.read_text().splitlines()[1:]:
        start, end, _, output, command = line.split('\t')
        runs[command] = (output, (int(end) - int(start)) / 1000)
    steps = defaultdict(float)
    for output, seconds in runs.values():
        folder = re.match(r'((?:tests/)?[^/]+)/(?:.*/)?CMakeFiles/', output)
        steps[folder[1] if folder else 'links and checks'] += seconds
    return steps


def test_runs():
    """Yields program, entry of ctest and its seconds."""
    text = (BUILD / 'Testing/Temporary/LastTest.log').read_text(errors='replace')
    for entry in re.split(r'^\d+/\d+ Testing: ', text, flags=re.M)[1:]:
        command = re.search(r'^Command: "([^"]+)"', entry, re.M)
        seconds = re.search(r'^Test time = +([\d.]+) sec', entry, re.M)
        if command and seconds:
            yield Path(command[1]).name, entry.split('\n', 1)[0], float(seconds[1])


def single_tests():
    """Yields test and its seconds, from the reports of GoogleTest."""
    for report in (BUILD / 'test_times').glob('*/*.json'):
        for suite in json.loads(report.read_text())['testsuites']:
            for test in suite['testsuite']:
                yield f'{suite["name"]}.{test["name"]}', float(test['time'].rstrip('s'))


def table(heading, rows):
    print(f'\n| {heading} | s |\n|---|---|')
    for name, seconds in sorted(rows.items(), key=lambda row: -row[1]):
        print(f'| {name} | {seconds:.0f} |')
    print(f'| together | {sum(rows.values()):.0f} |')


steps = build_steps(BUILD / '.ninja_log')
page = BUILD.parent / 'web/.ninja_log'
if page.exists():
    steps['web (the page, by Emscripten)'] = sum(build_steps(page).values())
table('build step', steps)

programs, tests = defaultdict(float), dict(single_tests())
for program, name, seconds in test_runs():
    is_script = program.endswith('.sh')
    programs[name if is_script else program] += seconds
    if not tests or is_script:
        tests[name] = seconds
table('test program', programs)

print(f'\n| s | the {SLOWEST} slowest tests |\n|---|---|')
groups = defaultdict(list)
for name, seconds in sorted(tests.items(), key=lambda row: -row[1])[:SLOWEST]:
    groups[round(seconds) or round(seconds, 1)].append(name)
for seconds, names in groups.items():
    print(f'| {seconds} | {", ".join(names)} |')
