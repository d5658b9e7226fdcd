#!/usr/bin/env python3
"""Changes the sources of a module in one place, many times, and runs the module's tests on each change: a
*mutant*. A mutant that no test notices, a survivor, shows what the tests do not check. Some survivors are
harmless, because the changed program does the same.

Only sources are changed, not headers: a header's inline functions are also compiled into the tests.
The work tree is not touched. build/mutants has the libraries, one object per source."""

import argparse
import concurrent.futures
import json
import os
import queue
import random
import re
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

MODULES = ['base', 'image', 'camera', 'scene', 'formats', 'splatting', 'oracle']
BUILD = Path('build/mutants').absolute()
MEMORY = 12 << 30  # bytes of address space per test: a mutant may allocate without end

# Operators are changed between spaces, where clang-format puts binary ones; templates have none.
OPERATORS = {' < ': ' <= ', ' <= ': ' < ', ' > ': ' >= ', ' >= ': ' > ', ' == ': ' != ', ' != ': ' == ',
             ' && ': ' || ', ' || ': ' && ', ' + ': ' - ', ' - ': ' + ', ' * ': ' / ', ' / ': ' * ',
             ' % ': ' / ', ' += ': ' -= ', ' -= ': ' += ', ' *= ': ' /= ', ' << ': ' >> ', ' >> ': ' << ',
             'std::min(': 'std::max(', 'std::max(': 'std::min(', 'true': 'false', 'false': 'true'}
OPERATOR = re.compile('|'.join(rf'\b{re.escape(o)}' if o[0].isalpha() else re.escape(o) for o in OPERATORS))
NUMBER = re.compile(r'(?<![\w.\'])(\d+\.\d*(?:[eE][-+]?\d+)?|\d+[eE][-+]?\d+|\d+)(?=[uUfFlL]*(?![\w.\']))')
STATEMENT = re.compile(r'^\s+(?!return |const |auto |using |else|if |for |while |case |throw |static |delete |goto )'
                       r'[\w:.\->\[\]()*+]+(?:\s[-+*/|&]?=\s.*|\(.*\)|\+\+|--)?;$|^\s+(?:break|continue|return);$')
NOT_CODE = re.compile(r'^\s*(//|#|using |namespace |template|static_assert|assert|\}|$)')


def masked(line):
    """The line with strings, characters and comments replaced by blanks of equal length."""
    line = re.sub(r'"(?:\\.|[^"\\])*"|\'(?:\\.|[^\'\\])\'', lambda m: '"' + ' ' * (len(m[0]) - 2) + '"', line)
    return re.sub(r'//.*', lambda m: ' ' * len(m[0]), line)


def larger(number):
    return str(int(number) + 1) if number.isdigit() else repr(2 * float(number) or 1.0)


def mutants_of(path):
    """All single changes of a source: (line from 0, kind, changed line)."""
    for i, line in enumerate(path.read_text().split('\n')):
        code = masked(line)
        if NOT_CODE.match(code) or 'R"' in line:
            continue
        for m in OPERATOR.finditer(code):
            kind = 'bound' if any(o in m[0] for o in '<>') and m[0] not in (' << ', ' >> ') else 'operator'
            yield i, kind, line[:m.start()] + OPERATORS[m[0]] + line[m.end():]
        for m in NUMBER.finditer(code):
            yield i, 'constant', line[:m.start()] + larger(m[0]) + line[m.end():]
        if STATEMENT.match(code.rstrip()):
            yield i, 'statement', ''


def test_programs(module):
    return re.findall(r'^tureen_test\((\w+)', Path(f'tests/{module}/CMakeLists.txt').read_text(), re.M)


def run(command, **how):
    return subprocess.run(command, capture_output=True, text=True, errors='replace', **how)


def build(modules):
    programs = [program for module in modules for program in test_programs(module)]
    for command in (['cmake', '--preset', 'mutants', f'-DTUREEN_MUTANTS={";".join(MODULES)}'],
                    ['cmake', '--build', '--preset', 'mutants', '--target', *programs]):
        made = run(command)
        if made.returncode:
            sys.exit(made.stdout[-3000:] + made.stderr[-3000:])


def ninja(*arguments):
    return run(['ninja', '-C', str(BUILD), '-t', *arguments], check=True).stdout


class Module:
    """What builds and tests a module: commands of the build, and the time of its unchanged tests."""

    def __init__(self, name, compile_commands, tests):
        self.name = name
        self.compile = compile_commands
        # Commands have several parts: the archiver's makes a library, the linker's a program.
        self.library = f'{name}/libtureen_{name}.a'
        archive = ninja('commands', '-s', self.library)
        self.objects = re.search(r' qc \S+ (.*?) &&', archive)[1].split()
        self.links = {}
        for program in test_programs(name):
            parts = ninja('commands', '-s', f'bin/{program}').split(' && ')
            self.links[program] = next(part for part in parts if f'-o bin/{program} ' in part)
        self.seconds = {}
        for program in self.links:
            begin = time.monotonic()
            if not passes(BUILD / 'bin' / program, 600, BUILD, tests):
                sys.exit(f'{program} fails without a change')
            self.seconds[program] = time.monotonic() - begin
        self.order = sorted(self.links, key=self.seconds.get)


def passes(program, seconds, folder, tests='-Thorough*'):
    """Whether the tests, by default those of `./dev test`, pass within the time."""
    child = subprocess.Popen(
        [str(program), '--gtest_brief=1', '--gtest_fail_fast', f'--gtest_filter={tests}'], cwd=BUILD,
        stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
        env={**os.environ, 'TMPDIR': str(folder), 'TEST_TMPDIR': str(folder)},
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY)))
    try:
        return child.wait(seconds) == 0
    except subprocess.TimeoutExpired:
        return False
    finally:
        try:
            os.killpg(child.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        child.wait()


def judge(module, mutant, folder, tests):
    """Compiles, links and tests a mutant; returns `uncompiled`, `survived`, or the program that failed."""
    shutil.rmtree(folder, ignore_errors=True)
    path = Path(mutant['file'])
    changed = folder / path
    changed.parent.mkdir(parents=True)
    lines = path.read_text().split('\n')
    lines[mutant['line'] - 1] = mutant['after']
    changed.write_text('\n'.join(lines))

    entry = module.compile[str(path.absolute())]
    words = shlex.split(entry['command'])
    words = words[1:] if Path(words[0]).name == 'ccache' else words
    original = words[words.index('-o') + 1]
    target = folder / 'changed.o'
    words = [str(target) if w == original else str(changed) if w == str(path.absolute()) else w for w in words]
    words.insert(1, f'-I{folder}')  # Highway's sources include themselves
    if run([w for w in words if w != '-Werror'], cwd=BUILD).returncode:
        return 'uncompiled'
    objects = [str(target) if o == original else o for o in module.objects]
    library = folder / 'changed.a'
    run(['ar', 'qcs', str(library), *objects], cwd=BUILD, check=True)
    for program in module.order:
        binary = folder / program
        link = module.links[program].replace(f'-o bin/{program} ', f'-fuse-ld=gold -o {binary} ')
        link = re.sub(rf'(?<!\S){module.library}(?!\S)', str(library), link)
        # A missing symbol is no mutant either.
        if run(link, shell=True, cwd=BUILD).returncode:
            return 'uncompiled'
        temporary = folder / 'tmp'
        temporary.mkdir(exist_ok=True)
        if not passes(binary, 20 + 5 * module.seconds[program], temporary, tests):
            return program
        binary.unlink()
    return 'survived'


def drawn(modules, count, seed):
    """Shares `count` among modules by the square root of their numbers of candidates, so that small modules
    have enough; yields per module its share and all its candidates in a random order."""
    candidates = {}
    for module in modules:
        found = []
        for path in sorted(Path(module).rglob('*.cpp')):
            before = path.read_text().split('\n')
            found += [{'module': module, 'file': str(path), 'line': i + 1, 'kind': kind, 'before': before[i], 'after': after}
                      for i, kind, after in mutants_of(path)]
        random.Random(f'{seed} {module}').shuffle(found)
        candidates[module] = found
    weights = {module: len(found) ** 0.5 for module, found in candidates.items()}
    for module, found in candidates.items():
        yield module, round(count * weights[module] / sum(weights.values())), found


def again(path):
    """The mutants of an earlier result. A line that has moved is searched for by its text."""
    for mutant in json.loads(Path(path).read_text()):
        lines = Path(mutant['file']).read_text().split('\n')
        places = [i + 1 for i, line in enumerate(lines) if line == mutant['before']]
        if places:
            yield {**mutant, 'was': mutant['result'], 'line': min(places, key=lambda i: abs(i - mutant['line']))}
        else:
            print(f'{mutant["file"]}:{mutant["line"]}: the line is gone: {mutant["before"].strip()}')


def main():
    parser = argparse.ArgumentParser(prog='./dev mutate', description=__doc__)
    parser.add_argument('modules', nargs='*', metavar='MODULE', help=f'{", ".join(MODULES)} (default: all)')
    parser.add_argument('--count', type=int, default=300, metavar='N', help='mutants that compile (default: 300)')
    parser.add_argument('--seed', type=int, default=1, help='of the random choice (default: 1)')
    parser.add_argument('--again', metavar='JSON', help='test the mutants of an earlier result instead')
    parser.add_argument('--survivors', action='store_true', help='with --again: only those that survived')
    parser.add_argument('--all', action='store_true', help='run the thorough tests, too')
    parser.add_argument('--json', metavar='FILE', help='the result (default: build/mutants.json, with --again build/mutants-again.json)')
    options = parser.parse_args()
    modules = options.modules or MODULES
    options.json = options.json or f'build/mutants{"-again" if options.again else ""}.json'
    if options.survivors and not options.again:
        parser.error('--survivors needs --again')
    if options.again and Path(options.again).resolve() == Path(options.json).resolve():
        parser.error('--json is the file of --again')
    for module in modules:
        if module not in MODULES:
            parser.error(f"there is no module '{module}' to change; modules: {', '.join(MODULES)}")

    print('Building the libraries and tests', flush=True)
    build(modules)
    compile_commands = {e['file']: e for e in json.loads((BUILD / 'compile_commands.json').read_text())}
    if options.again:
        rerun = [m for m in again(options.again) if m['module'] in modules and
                 (m['was'] == 'survived' or not options.survivors)]
        plan = [(m, len(chosen), chosen) for m in modules if (chosen := [r for r in rerun if r['module'] == m])]
    else:
        plan = list(drawn(modules, options.count, options.seed))
    folders = queue.SimpleQueue()
    workers = os.cpu_count() or 1
    for i in range(workers):
        folders.put(BUILD / f'mutant{i}')
    results, begin = [], time.monotonic()
    total = sum(share for _, share, _ in plan)
    for name, share, candidates in plan:
        module = Module(name, compile_commands, '*' if options.all else '-Thorough*')
        candidates = [c for c in candidates if str(Path(c['file']).absolute()) in compile_commands]

        def tried(mutant, module=module):
            folder = folders.get()
            try:
                return {**mutant, 'result': judge(module, mutant, folder, '*' if options.all else '-Thorough*')}
            finally:
                folders.put(folder)

        done = []
        with concurrent.futures.ThreadPoolExecutor(workers) as pool:
            # Each batch has the number that is still missing, so every run counts the same mutants.
            while candidates and len(done) < share:
                batch, candidates = candidates[:share - len(done)], candidates[share - len(done):]
                for result in pool.map(tried, batch):
                    if result['result'] == 'uncompiled' and options.again:
                        print(f'{result["file"]}:{result["line"]}: no longer compiles', flush=True)
                    if result['result'] != 'uncompiled':
                        done.append(result)
                        n = len(results) + len(done)
                        left = (time.monotonic() - begin) / n * (total - n) / 60
                        print(f'{n}/{total}, {left:.0f} min left: {result["file"]}:{result["line"]}: '
                              f'{result["kind"]}: {result["result"]}', flush=True)
        results += done
        Path(options.json).parent.mkdir(exist_ok=True)
        Path(options.json).write_text(json.dumps(results, indent=1) + '\n')

    print(f'\n{"module":10} {"mutants":>8} {"killed":>7} {"survived":>9}')
    for name, _, _ in plan:
        counts = Counter(r['result'] == 'survived' for r in results if r['module'] == name)
        print(f'{name:10} {counts.total():8} {counts[False]:7} {counts[True]:9}')
    for r in results:
        if r['result'] == 'survived':
            print(f'\nsurvived: {r["file"]}:{r["line"]}\n  - {r["before"].strip()}\n  + {r["after"].strip()}')
    escaped = [r for r in results if r['result'] == 'survived' and r.get('was', 'survived') != 'survived']
    for r in escaped:
        print(f'\nno longer killed by {r["was"]}: {r["file"]}:{r["line"]}')
    print(f'\n{time.monotonic() - begin:.0f} s; {options.json}')
    return 1 if escaped else 0


if __name__ == '__main__':
    sys.exit(main())
