#!/usr/bin/env python3
"""Runs the measurements of `./dev bench`, `./dev numerics` and `./dev faults`, and writes JSON into build/;
docs/json.md explains its keys. `dev` builds the programs first."""

import argparse
import concurrent.futures
import datetime
import json
import math
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

PROGRAMS = Path(os.environ.get('TUREEN_PROGRAMS', 'build/release/bin'))
TUREEN = PROGRAMS / 'tureen'
EXAMPLE = Path('examples/soup.glb')
# Training sets: the folder in --data (None: this script draws it), the scale of its images, options of `tureen train`.
SETS = {
    'example': (None, 1, '--config examples/training.json'),
    'lego': ('rendered/lego', 0.5, '--steps 10000'),
    'fox': ('photos/fox', 0.25, '--steps 10000'),
    'bottle': ('photos/bottle', 0.5, '--steps 1500'),
}
LAYER_FILL = 0.8  # layered_soup_fill, tests/bench/layered_soup.hpp


def say(text):
    print(f'==> {text}', file=sys.stderr, flush=True)


def rows_of(text):
    return [json.loads(line) for line in text.splitlines() if line.startswith('{')]


def short(value):
    if isinstance(value, bool):
        return 'yes' if value else 'no'
    return '' if value is None else f'{value:.4g}' if isinstance(value, float) else str(value)


def print_table(rows, columns=None, title=None):
    """Prints text columns first; numbers are right-aligned."""
    if title:
        print(f'{title}:')
    columns = columns or sorted(dict.fromkeys(key for row in rows for key in row),
                                key=lambda column: not any(isinstance(row.get(column), str) for row in rows))
    lines = [columns] + [[short(row.get(column)) for column in columns] for row in rows]
    widths = [max(len(line[i]) for line in lines) for i in range(len(columns))]
    right = [any(isinstance(row.get(c), (int, float)) for row in rows) for c in columns]
    for line in lines:
        print('  '.join(cell.rjust(w) if r else cell.ljust(w)
                        for cell, w, r in zip(line, widths, right)).rstrip())
    print()


def keep(path, name, tables, plots=()):
    """Writes a result in the format "tureen measurements"."""
    cpuinfo = Path('/proc/cpuinfo')
    cpu = re.search(r'^model name\s*: (.*)$', cpuinfo.read_text() if cpuinfo.exists() else '', re.M)
    commit = subprocess.run(['git', 'describe', '--always', '--dirty'], capture_output=True, text=True).stdout.strip()
    result = {
        'format': 'tureen measurements', 'version': 1, 'name': name,
        'date': datetime.datetime.now(datetime.timezone.utc).strftime('%Y-%m-%dT%H:%M:%SZ'),
        'commit': commit or 'unknown',
        'machine': {'cpu': cpu[1] if cpu else 'unknown', 'cores': os.cpu_count()},
        'arguments': sys.argv[1:], 'tables': tables, 'plots': list(plots)}
    path.write_text(json.dumps(result, indent=1) + '\n')


class Bench:
    """The parts of `./dev bench`, each a method. A program that fails is reported at the end."""

    def __init__(self, options):
        self.options = options
        self.quick = options.quick
        self.out = Path('build/bench-quick' if options.quick else 'build/bench')
        (self.out / 'soups').mkdir(parents=True, exist_ok=True)
        self.outcomes = []

    def skip(self, name, reason):
        self.outcomes.append({'part': name, 'outcome': f'skipped: {reason}'})

    def run(self, name, *command):
        """The standard output, or None if the command failed. Standard error goes to NAME.log."""
        command = [str(word) for word in command]
        say(f'{name}: {shlex.join(command)}')
        with open(self.out / f'{name}.log', 'w') as log:
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=log, text=True)
        if done.returncode == 0:
            return done.stdout
        self.outcomes.append({'part': name, 'outcome': f'FAILED, see {self.out}/{name}.log'})
        return None

    def tureen(self, name, *arguments):
        """Runs tureen, keeps the JSON that it prints as NAME.json, and returns it."""
        text = self.run(name, TUREEN, *arguments, '--json')
        if text is None:
            return None
        (self.out / f'{name}.json').write_text(text)
        self.outcomes.append({'part': name, 'outcome': f'{self.out}/{name}.json'})
        return json.loads(text)

    def keep(self, name, tables, plots=()):
        if not any(tables.values()):
            return
        keep(self.out / f'{name}.json', name, tables, plots)
        self.outcomes.append({'part': name, 'outcome': f'{self.out}/{name}.json'})
        for table, rows in tables.items():
            print_table(rows, title=table)

    def timing(self, seconds):
        words = ['--rounds', 1, '--seconds', 1] if self.quick else ['--rounds', 5, '--seconds', seconds]
        return words + (['--processor-time'] if self.options.processor_time else [])

    def size(self, size):
        return ['--size', '160x90' if self.quick else size]

    def soup(self, name, program, *arguments):
        """Path of a soup made by one of our programs; None if that failed."""
        path = self.out / 'soups' / f'{name}.glb'
        return path if self.run(name, PROGRAMS / program, path, *arguments) is not None else None

    def dense_soup(self):
        return self.soup('dense', 'make_soup', '--dense', self.base(),
                         '--triangles', 50000 if self.quick else 2000000)

    def base(self):
        ficus = self.options.data / 'soups/ficus_2dts.off'
        return ficus if ficus.exists() else EXAMPLE

    def cloud(self, coverage):
        return self.soup(f'cloud-{coverage}', 'make_cutout_cloud', '--coverage', coverage)

    def scenes(self):
        """Names and paths of all scenes: the example, ficus if available, trained soups, and --scene."""
        found = {'example': EXAMPLE}
        if self.base() != EXAMPLE:
            found['ficus'] = self.base()
        for path in sorted((self.out / 'training').glob('*.glb')) + self.options.scene:
            found[path.stem if path.stem != 'example' else 'trained-example'] = path
        return found

    def photographs(self, name):
        """The folder of a training set and the scale of its images; empty if the folder does not exist."""
        if name not in SETS:
            return []
        inside, scale, _ = SETS[name]
        folder = self.options.data / inside if inside else self.out / 'photographs'
        return [folder, '--scale', scale] if folder.exists() else []

    def frames(self):
        """Frame times of tureen and of the baseline, at several sizes."""
        for name, path in self.scenes().items():
            views = self.size('') if self.quick else ['--cameras', 'hemisphere:8,adversarial', '--sweep']
            self.tureen(f'frames-{name}', 'bench', path, *views, *self.timing(300))
        for coverage in 'forty_percent', 'all':
            if path := self.cloud(coverage):
                self.tureen(f'frames-cloud-{coverage}', 'bench', path, '--cameras', path,
                            *self.size('1280x720'), *self.timing(300))

    def splats(self):
        """The time of a frame against the number of splats, the size of the image and the cores."""
        middle = 1000 if self.quick else 100000
        scenes = {n: self.soup(f'gaussians-{n}', 'make_gaussians', '--splats', n)
                  for n in ([100, middle] if self.quick else [1000, 10000, middle, 1000000])}
        one_size = self.size('1280x720')
        cores = [str(core) for core in sorted(os.sched_getaffinity(0))] if hasattr(os, 'sched_getaffinity') else []
        sweep = ['--size', '160x90,320x180'] if self.quick else \
            ['--size', '640x360,1280x720,1920x1080,2560x1440,3840x2160']
        tables = {
            'splats': [{'splats': n, **row} for n, path in scenes.items() for row in self.splat_rows(path, one_size)],
            'pixels': self.splat_rows(scenes[middle], sweep),
            'cores': [{'cores': n, **row} for n in (1, 2) if shutil.which('taskset') and n <= len(cores)
                      for row in self.splat_rows(scenes[middle], one_size, 'taskset', '-c', ','.join(cores[:n]))]}
        columns = [f'{name}_ms' for name in ('tureen', 'raster', 'generic', 'published')]
        self.keep('splats', tables, [{'table': table, 'x': x, 'y': columns}
                                     for table, x in (('splats', 'splats'), ('pixels', 'pixels'), ('cores', 'cores'))])

    def splat_rows(self, path, size, *wrapper):
        """A row for each size, with the time of each case."""
        name = '-'.join(['splats', path.stem, *map(str, size[1:]), *wrapper[2:]]) if path else ''
        text = path and self.run(name, *wrapper, TUREEN, 'bench', path, '--cameras', 'orbit:3', *size,
                                 *self.timing(60), '--json')
        rows = {}
        for measured in json.loads(text)['measurements'] if text else []:
            row = rows.setdefault(measured['size'], {'size': measured['size'],
                                                     'pixels': measured['width'] * measured['height']})
            row[f"{measured['configuration']}_ms"] = measured['frame_ms']['min_of_medians']
        return list(rows.values())

    def dense(self):
        """Two million opaque triangles, compared with a minimal renderer."""
        if soup := self.dense_soup():
            text = self.run('dense', PROGRAMS / 'dense_benchmark', soup,
                            *(['--rounds', 1, '--width', 160, '--height', 90] if self.quick else []),
                            *(['--processor-time'] if self.options.processor_time else []))
            self.keep('dense', {'dense': rows_of(text or '')})

    def gpu(self):
        """Frame times of tureen, the baseline and the upper limits of the device, from 1280x720 to 3840x2160."""
        drawn = json.loads(self.run('gpu-device', TUREEN, 'render', EXAMPLE, '--size', '16x16', '-o',
                                    self.out / 'device.png', '--force', '--json') or '{}')
        if drawn.get('software') and not self.quick:
            return self.skip('gpu', 'OpenGL is software on this machine')
        scenes = {name: (path, 'hemisphere:8') for name, path in self.scenes().items()}
        for name, path in ('dense', self.dense_soup()), ('cloud-all', self.cloud('all')):
            if path:
                scenes[name] = path, path if name == 'cloud-all' else 'orbit:8'
        for name, (path, cameras) in scenes.items():
            self.tureen(f'gpu-{name}', 'bench', path, '--ceilings', '--cameras', cameras,
                        *self.size('1280x720,1920x1080,3840x2160'), *self.timing(60))

    def specialisations(self):
        """Gain of each specialisation, on a scene made for it and on all scenes."""
        text = self.run('specialisations', PROGRAMS / 'specialisation_benchmark', *self.scenes().values(),
                        *(['--rounds', 1, '--width', 160, '--height', 90] if self.quick else []))
        self.keep('specialisations', {'specialisations': rows_of(text or '')})

    def growth(self):
        """The time of a frame against triangles, pixels and overdraw, and its cost model."""
        most = 16000 if self.quick else 4000000
        triangles = [n for n in (1024 * 4**i for i in range(6)) if n < most] + [most]
        sizes = ['160x90', '320x180'] if self.quick else \
            ['320x180', '640x360', '1280x720', '1920x1080', '2560x1440', '3840x2160']
        middle = ['160x90' if self.quick else '1280x720']
        series = {'triangles': [(n, 4, middle) for n in triangles],
                  'pixels': [(min(most, 65536), 4, sizes)],
                  'layers': [(min(most, 65536), n, middle) for n in (1, 2, 4, 8, 16, 32)]}
        tables = {name: [row for point in points for row in self.layered(*point)]
                  for name, points in series.items()}
        tables['model'] = [model for kind in ('opaque', 'cut_out')
                           if (model := fit(kind, [row for rows in tables.values() for row in rows]))]
        self.keep('growth', tables, [
            {'table': table, 'x': x, 'y': ['opaque_ms', 'opaque_model_ms', 'cut_out_ms', 'cut_out_model_ms']}
            for table, x in (('triangles', 'triangles'), ('pixels', 'pixels'), ('layers', 'fragments'))])

    def layered(self, triangles, layers, sizes):
        """A row for each size: frames of an opaque and of a cut-out soup of layers."""
        rows = {}
        for kind in 'opaque', 'cut_out':
            path = self.soup('layers', 'make_soup', '--triangles', triangles, '--layers', layers,
                             *(['--cut-out'] if kind == 'cut_out' else []))
            text = path and self.run(f'growth-{kind}', TUREEN, 'bench', path, '--cameras', path, '--size',
                                     ','.join(sizes), '--only', 'tureen', *self.timing(20), '--json')
            if not text:
                continue
            result = json.loads(text)
            for measured in result['measurements']:
                pixels = round(LAYER_FILL**2 * measured['width'] * measured['height'])
                row = rows.setdefault(measured['size'], {
                    'triangles': result['scene']['triangles'], 'fragments': layers * pixels, 'pixels': pixels})
                row[f'{kind}_ms'] = measured['frame_ms']['min_of_medians']
                row[f'{kind}_spread'] = measured['frame_ms']['spread']
        return list(rows.values())

    def tradeoff(self):
        """Error against run time, with photographs if available."""
        for name, path in self.scenes().items():
            self.tureen(f'tradeoff-{name}', 'tradeoff', path, *self.photographs(name),
                        *(['--quick'] if self.quick else []),
                        *(['--processor-time'] if self.options.processor_time else []))

    def load(self):
        """Time and memory for loading a large soup from each format."""
        dense, rows = self.dense_soup(), []
        for end in '.glb', '.off', '.ply':
            path = dense and dense.with_suffix(end)
            if not dense or end != '.glb' and \
                    self.run(f'load{end}', TUREEN, 'convert', dense, '--force', path) is None:
                continue
            text = self.run(f'load{end}', TUREEN, 'bench', path, '--only', 'tureen', '--size', '16x16',
                            '--rounds', 1, '--json')
            if text:
                result = json.loads(text)
                rows.append({'file': path.name, 'file_mib': path.stat().st_size / 2**20,
                             'triangles': result['scene']['triangles'], **result['load']})
        self.keep('load', {'load': rows})

    def compress(self):
        """Size and loss of compressed files."""
        rows = []
        for name, path in self.scenes().items():
            photographs = self.photographs(name)
            text = self.run(f'compress-{name}', TUREEN, 'convert', path, self.out / 'soups/compressed.glb',
                            '--compress', '--force', '--json', *(['--photographs', *photographs] if photographs else []))
            export = self.out / 'soups/export'
            exported = self.run(f'export-{name}', TUREEN, 'convert', path, f'{export}/', '--force', '--json')
            if text:
                row = {key: value for key, value in json.loads(text).items() if isinstance(value, (int, float, str))}
                if exported:
                    row['published_bytes'] = sum(file.stat().st_size for file in export.iterdir())
                    row['times_smaller'] = row['published_bytes'] / row['scene_bytes']
                rows.append({'scene': name, **row})
        self.keep('compress', {'compress': rows})

    def step(self):
        """Time of a training step, stage by stage."""
        text = self.run('step', PROGRAMS / 'training_benchmark', *(['--width', 64, '--height', 64, '--steps', 1] if self.quick else ['--steps', 12]))
        self.keep('step', {'step': rows_of(text or '')})

    def browser(self):
        """The same frames in Chromium, the scene's memory, and the time until the first image."""
        if not Path('build/web/out/site/bench.html').exists():
            return self.skip('browser', 'the page is not built: ./dev web')
        if cloud := self.cloud('third'):
            text = self.run('browser', 'node', 'tests/bench/browser_benchmark.mjs', self.out / 'browser',
                            cloud, EXAMPLE, *(['--quick'] if self.quick else []))
            self.keep('browser', {'browser': rows_of(text or '')})

    def viewers(self):
        """Gaussians in Tureen's page and in viewers from npm, which it installs into tests/bench/viewers."""
        scene = next((path for path in self.options.scene if path.suffix == '.ply'),
                     self.options.data / 'gaussians/guitar_3dgs_dc.ply')
        if not scene.exists():
            return self.skip('viewers', f'{scene} does not exist: --scene GAUSSIANS.ply')
        if not Path('build/web/out/site/viewer.js').exists():
            return self.skip('viewers', 'the page is not built: ./dev web')
        views = scene.with_suffix('.views.json')
        text = self.run('viewers', 'node', 'tests/bench/viewers_benchmark.mjs', self.out / 'viewers', scene,
                        *(['--views', views] if views.exists() else []), *(['--quick'] if self.quick else []))
        self.keep('viewers', {'viewers': rows_of(text or '')})

    def training(self):
        """Trains all available sets, which takes hours. Other parts use the trained soups."""
        (self.out / 'training').mkdir(exist_ok=True)
        if not self.photographs('example'):
            self.run('photographs', PROGRAMS / 'make_photographs', self.out / 'photographs',
                     *shlex.split('--views 9 --test-views 1 --strata 1' if self.quick else
                                  '--views 90 --test-views 10 --strata 4'))
        rows = []
        for name, (_, _, options) in SETS.items():
            photographs, soup = self.photographs(name), self.out / 'training' / f'{name}.glb'
            if not photographs:
                self.skip(f'training-{name}', f'{self.options.data}/{SETS[name][0]} does not exist')
                continue
            soup.with_suffix('.checkpoint').unlink(missing_ok=True)  # from an interrupted run
            options = shlex.split(options) + (['--steps', '20'] if self.quick else [])
            text = self.run(f'training-{name}', TUREEN, 'train', *photographs, *options, '-o', soup, '--json')
            if text:
                result = json.loads(text)
                rows.append({'dataset': name, **result.pop('test'), **result})
        self.keep('training', {'training': rows})

    def report(self):
        """A page with all results in the folder."""
        found = [path for pattern in ('*.json', 'browser/*.json', 'training/*.jsonl')
                 for path in sorted(self.out.glob(pattern))]
        page = self.out / 'report.html'
        if found and self.run('report', TUREEN, 'report', *found, '-o', page) is not None:
            self.outcomes.append({'part': 'report', 'outcome': str(page)})


def fit(kind, rows):
    """t = a + b triangles + c fragments + d pixels, by least squares of the relative error: 1 ms counts
    as much as 1000 ms. Adds the model's time to the rows. None if the rows do not determine the four costs."""
    rows = [row for row in rows if f'{kind}_ms' in row]
    factors = [[1, row['triangles'], row['fragments'], row['pixels']] for row in rows]
    scaled = [[value / row[f'{kind}_ms'] for value in line] for line, row in zip(factors, rows)]
    # Columns of length 1: without this scaling, costs that differ by 10^9 would lose digits.
    lengths = [math.sqrt(sum(line[i]**2 for line in scaled)) for i in range(4)]
    if len(rows) <= 4:
        return None
    unit = [[line[i] / lengths[i] for i in range(4)] for line in scaled]
    equations = [[sum(line[i] * line[k] for line in unit) for k in range(4)] + [sum(line[i] for line in unit)]
                 for i in range(4)]
    for i in range(4):  # the matrix is positive definite: no pivots are needed
        if equations[i][i] < 1e-10:  # fewer than 6 of 16 digits would remain
            return None
        for k in set(range(4)) - {i}:
            ratio = equations[k][i] / equations[i][i]
            equations[k] = [a - ratio * b for a, b in zip(equations[k], equations[i])]
    costs = [equations[i][4] / equations[i][i] / lengths[i] for i in range(4)]
    worst = 0
    for line, row in zip(factors, rows):
        row[f'{kind}_model_ms'] = sum(cost * value for cost, value in zip(costs, line))
        worst = max(worst, abs(row[f'{kind}_model_ms'] / row[f'{kind}_ms'] - 1))
    return {'kind': kind, 'frame_ms': costs[0], 'triangle_ns': 1e6 * costs[1], 'fragment_ns': 1e6 * costs[2],
            'pixel_ns': 1e6 * costs[3], 'worst_residual': worst}


# The first two run only when named.
PARTS = ['training', 'viewers', 'frames', 'splats', 'dense', 'gpu', 'specialisations', 'growth', 'tradeoff', 'load', 'compress', 'step', 'browser']

def bench(arguments):
    parts = ''.join(f'  {name:16} {getattr(Bench, name).__doc__}\n' for name in PARTS)
    parser = argparse.ArgumentParser(
        prog='./dev bench', formatter_class=argparse.RawDescriptionHelpFormatter,
        description='Measures, and writes JSON into build/bench. Default: all parts except training and '
                    'viewers.',
        epilog=f'parts:\n{parts}\nExit code 1 if a part failed.')
    parser.add_argument('part', nargs='*', metavar='PART', help='listed below')
    parser.add_argument('--quick', action='store_true',
                        help='smallest settings, into build/bench-quick: a check of the programs, not a measurement')
    parser.add_argument('--processor-time', action='store_true',
                        help='processor time of all threads, for ratios on a busy machine; software OpenGL only')
    parser.add_argument('--scene', action='append', default=[], type=Path, metavar='FILE',
                        help='measure this soup, too')
    parser.add_argument('--data', default=Path('../shared/data'), type=Path, metavar='FOLDER',
                        help='folder with soups/ficus_2dts.off, gaussians/guitar_3dgs_dc.ply, rendered/lego, '
                             'photos/fox and photos/bottle, all optional (default ../shared/data)')
    parser.add_argument('--check', action='store_true', help=argparse.SUPPRESS)  # only checks the arguments
    options = parser.parse_args(arguments)
    if options.data != parser.get_default('data') and not options.data.is_dir():
        parser.error(f'--data: folder {options.data} does not exist')
    for part in options.part:
        part in PARTS or parser.error(f"unknown part '{part}'; the parts are {', '.join(PARTS)}")
    for path in options.scene:
        path.exists() or parser.error(f'--scene: file {path} does not exist')
    if options.check:
        return 0
    run = Bench(options)
    for part in sorted(options.part or PARTS[2:], key=PARTS.index):
        getattr(run, part)()
    run.report()
    print_table(run.outcomes)
    return int(any('FAILED' in each['outcome'] for each in run.outcomes))


def tested(path, program, *arguments, **environment):
    """The rows that our tests write, by table. Exits if a test fails."""
    path.unlink(missing_ok=True)
    environment = {**os.environ, **environment, 'TUREEN_MEASURED': str(path.absolute())}
    command = [PROGRAMS / program, '--gtest_brief=1', *arguments]
    if subprocess.run(command, env=environment, stdout=sys.stderr).returncode:
        sys.exit('tests failed, see above')
    tables = {}
    for row in rows_of(path.read_text()):
        tables.setdefault(row.pop('table'), []).append(row)
    path.unlink()
    return tables


def numerics(_):
    out = Path('build/numerics')
    out.mkdir(parents=True, exist_ok=True)
    cases, points, names = [], [], set()
    for case in tested(out / 'rows', 'numerics_tests')['numerics']:
        while case['case'] in names:  # a test may have several cases
            case['case'] += "'"
        names.add(case['case'])
        measured = case.pop('points')
        points += [{'case': case['case'], **point} for point in measured]
        worst = max(measured, key=lambda p: (p['ours'] / p['tolerance'] if p['tolerance'] else 0, p['ours']))
        margin = worst['tolerance'] / worst['ours'] if worst['ours'] else None
        cases.append({**case, **worst, 'margin': margin})
    cases.sort(key=lambda row: [int(word) if word.isdigit() else word for word in re.split(r'(\d+)', row['case'])])
    keep(out / 'numerics.json', 'numerics', {'cases': cases, 'points': points},
         [{'table': 'points', 'x': 'at', 'y': ['ours', 'naive', 'tolerance'], 'each': 'case'}])
    print_table(cases, ['case', 'at', 'ours', 'naive', 'tolerance', 'margin', 'quantity', 'stressed'])
    say(f'{len(cases)} cases in {out}/numerics.json')


def fuzzed(target, seconds, out):
    """The final statistics of a fuzzer, as a row."""
    log = out / f'{target}.log'
    source = Path.cwd()
    with open(log, 'w') as file:
        status = subprocess.run(
            ['tests/fuzz/run.sh', source, source / 'build/release/fuzz_seeds', source / 'build/fuzz', target, seconds,
             source / 'build/fuzz/corpus' / target], stdout=file, stderr=subprocess.STDOUT).returncode
    text = log.read_text(errors='replace')
    labels = {'executions': 'stat::number_of_executed_units:', 'per_second': 'stat::average_exec_per_sec:',
              'edges': 'cov:', 'inputs': 'corp:', 'fuzz_memory_mb': 'stat::peak_rss_mb:'}
    found = {key: re.findall(re.escape(label) + r'\s*(\d+)', text) for key, label in labels.items()}
    if status or not all(found.values()):
        sys.exit(f'fuzzing {target} failed, see {log}')
    return {key: int(values[-1]) for key, values in found.items()}


def faults(arguments):
    seconds = arguments[0]
    out = Path('build/harm')
    out.mkdir(parents=True, exist_ok=True)
    say('Damaging files and interrupting programs')
    tables = tested(out / 'rows', 'hostile_tests', TUREEN_FLIPS='10000')
    tables.update(tested(out / 'rows', 'program_tests', '--gtest_filter=*Faults.*-Faults.ASignal*:TrainFaults.ASignal*'))
    targets = re.findall(r'^TARGET\((\w+)\)', Path('tests/fuzz/targets.def').read_text(), re.M)
    say(f'Fuzzing {len(targets)} readers, {seconds} seconds each')
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = dict(zip(targets, pool.map(lambda target: fuzzed(target, seconds, out), targets)))
    for row in tables['readers']:
        row.update(runs[row['reader']])
    keep(out / 'harm.json', 'faults', tables)
    for table, rows in tables.items():
        print_table(rows, title=table)
    say(f'All results are in {out}/harm.json')


if __name__ == '__main__':
    try:
        sys.exit({'bench': bench, 'numerics': numerics, 'faults': faults}[sys.argv[1]](sys.argv[2:]))
    except KeyboardInterrupt:
        sys.exit(130)
