#!/usr/bin/env python3
"""Judges that are not ours. @playcanvas/splat-transform reads what Tureen writes, and Tureen reads what it, spz-js and
GaussianSplats3D write; two readers of one file must draw the same: their images differ by at most one 8-bit step a
value, 48.1 dB. Babylon and Spark, in a browser, read the same files; what they hold of each splat is compared with what
Tureen reads. For development; needs Node 20, npm, and Debian's chromium-headless-shell or chromium.

    tests/judges.py [--tureen build/release/bin/tureen] [--scene tests/formats/data/splat_transform.ply]"""

import argparse
import atexit
import dataclasses
import json
import math
import os
import queue
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
from array import array
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

PACKAGES = ['@playcanvas/splat-transform@2.7.1', 'spz-js@1.2.5', '@mkkellogg/gaussian-splats-3d@0.4.7',
            'babylonjs@9.28.0', 'babylonjs-loaders@9.28.0', '@adobe/spz@0.2.2', 'fflate@0.8.2',  # the last two for it
            '@sparkjsdev/spark@2.2.0', 'three@0.187.0']
FORMATS = ['.sog', '.spz', '.compressed.ply', '.ply']
ONE_STEP = 20 * math.log10(255)  # PSNR of images that differ by one step everywhere
SH_0 = 0.28209479177387814  # the harmonic of degree 0


def clamped(lowest, highest):
    return lambda values: [min(max(value, lowest), highest) for value in values]


def below_powers(values):
    """Spark stores the channels of a coefficient in units of 2^n / 255, 2^n below the largest: it clamps them to 2^n."""
    held = []
    for triple in zip(*[iter(values)] * 3):
        top = 2.0 ** math.floor(math.log2(max(max(map(abs, triple)), 2**-15)))
        held += clamped(-top, top)(triple)
    return held


@dataclasses.dataclass
class Judge:
    """A reader in the browser, tests/judges/NAME.js."""
    name: str
    formats: list
    largest: dict  # difference by quantity: of positions relative to the scene, of logarithms of sizes
    colors: object  # what it holds of three colours
    harmonics: object  # what it holds of harmonics
    known: dict  # largest difference by (format, quantity), or None, where its reader differs
    # It keeps the axes of SPZ, where Tureen turns them to those of PLY.
    stored_axes = ['.3.spz', '.spz']


BROWSERS = [
    # Singles, and bytes, some of them truncated: 1 / 255 in opacities and colours, 2 / 255 in harmonics. Rotations are
    # rounded by 1 / 255 a part, and again as far as the others' rounding changes their length, by up to twice that.
    Judge('babylon', ['.ply', '.compressed.ply', '.splat', '.3.spz', '.spz', '.sog'],
          {'position': 1e-6, 'size': 1e-5, 'rotation': 3 / 255, 'opacity': 1 / 255, 'colour': 1 / 255, 'harmonics': 2 / 255},
          clamped(0, 1), clamped(-1, 1),
          # A canvas multiplies bytes by alpha, and divides them again: indices of colours become others, and bytes of
          # rotations differ by a step, sqrt(2) / 255 a part and up to three times that in the largest.
          {('.compressed.ply', 'harmonics'): 1 / 64 + 2 / 255,  # bytes are 8 / 255 apart, not the middle of 8 / 256
           ('.sog', 'colour'): None, ('.sog', 'rotation'): 3 * math.sqrt(2) / 255 + 3 / 255}),
    # Truncated halves: 2^-11 of opacities, 2^-10 of colours below 2, 2^-7 of logarithms below 16. Directions
    # of the axis in 10 + 10 bits, the angle in 12. Harmonics: 8 bits below 2^n.
    Judge('spark', ['.ply', '.compressed.ply', '.splat', '.3.spz', '.sog', '.ksplat'],  # no SPZ 4
          {'position': 1e-6, 'size': 2**-7, 'rotation': 2**-8, 'opacity': 2**-11, 'colour': 2**-10, 'harmonics': 2**-8},
          list, below_powers,
          # It does not normalise rotations, whose first part is the cosine of half the angle: bytes as (b - 128) / 128,
          # up to 127 / 128, turn by 1 / 8 where nothing turns, halves below 1 by 2^-5.
          {('.splat', 'rotation'): 1 / 8, ('.ksplat', 'rotation'): 2**-5,
           # Bytes are 8 / 255 apart, where splat-transform and Tureen take the middle of steps of 8 / 256.
           ('.compressed.ply', 'harmonics'): 1 / 64 + 2**-8}),
]

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument('--tureen', default='build/release/bin/tureen', type=Path)
parser.add_argument('--scene', default='tests/formats/data/splat_transform.ply', type=Path, help='Gaussians in a PLY')
parser.add_argument('--packages', type=Path, help='a folder with the packages; default: npm installs them')
arguments = parser.parse_args()
wrong = 0


def report(passed, text):
    global wrong
    wrong += not passed
    print(f'{"ok   " if passed else "WRONG"} {text}', flush=True)


class Server(SimpleHTTPRequestHandler):
    """Serves the page of the judges, the packages and the files; takes results."""

    def __init__(self, *parts, roots, tasks, results, **named):
        self.roots, self.tasks, self.results = roots, tasks, results
        super().__init__(*parts, **named)

    def translate_path(self, path):
        first, _, rest = path.split('?')[0].lstrip('/').partition('/')
        return str(self.roots[first] / rest) if first in self.roots else '/nowhere'

    def do_POST(self):
        """Takes a result, or, for an empty one, sends the next task."""
        body = self.rfile.read(int(self.headers['Content-Length']))
        if body:
            self.results.put((self.headers.get('degree'), body))
        task = b'' if body else json.dumps(self.tasks.get()).encode()
        self.send_response(200)
        self.send_header('Content-Length', str(len(task)))
        self.end_headers()
        self.wfile.write(task)

    def log_message(self, *_):
        pass


def splats_of_ply(path):
    """The values of judge.html, from a PLY that Tureen writes, and the degree."""
    data = path.read_bytes()
    header, _, body = data.partition(b'end_header\n')
    names = [line.split()[2] for line in header.decode().splitlines() if line.startswith('property float ')]
    numbers = sum(name.startswith('f_rest_') for name in names)
    rows = array('f', body)
    columns = {name: rows[i::len(names)] for i, name in enumerate(names)}
    columns.update({f'scale_{i}': map(math.exp, columns[f'scale_{i}']) for i in range(3)})
    columns['opacity'] = (1 / (1 + math.exp(-value)) if value > -700 else 0 for value in columns['opacity'])
    columns.update({f'f_dc_{i}': (0.5 + SH_0 * value for value in columns[f'f_dc_{i}']) for i in range(3)})
    order = ['x', 'y', 'z', 'scale_0', 'scale_1', 'scale_2', 'rot_0', 'rot_1', 'rot_2', 'rot_3', 'opacity',
             'f_dc_0', 'f_dc_1', 'f_dc_2']
    order += [f'f_rest_{channel * numbers // 3 + k}' for k in range(numbers // 3) for channel in range(3)]
    values = array('f', bytes(4 * len(order) * (len(rows) // len(names))))
    for i, name in enumerate(order):
        values[i::len(order)] = array('f', columns[name])
    return math.isqrt(numbers // 3 + 1) - 1, values


def pairs(ours, theirs, stride):
    """Rows of the same splat: Tureen reads into Morton order. Nearest in place, then in the other values."""
    size = max(max(ours[axis::stride]) - min(ours[axis::stride]) for axis in range(3))
    cell = 1e-5 * size  # ten times the largest difference of a position
    cells = {}
    for at in range(0, len(theirs), stride):
        cells.setdefault(tuple(round(value / cell) for value in theirs[at:at + 3]), []).append(theirs[at:at + stride])
    for at in range(0, len(ours), stride):
        own = ours[at:at + stride]
        x, y, z = (round(value / cell) for value in own[:3])
        near = [(x + i, y + j, z + k) for i in (0, -1, 1) for j in (0, -1, 1) for k in (0, -1, 1)]
        found = [(sum(abs(a - b) for a, b in zip(own[:6] + own[10:], row[:6] + row[10:])), key, i)
                 for key in near for i, row in enumerate(cells.get(key, ()))]
        if not found:
            yield own, None
            continue
        _, key, i = min(found)
        yield own, cells[key].pop(i)


def turn_between(a, b):
    """The largest difference of two unit quaternions. An ellipsoid stays the same by half a turn about an axis, and by
    the opposite sign."""
    length = math.hypot(*a), math.hypot(*b) or 1
    (w, x, y, z), b = (value / length[0] for value in a), [value / length[1] for value in b]
    forms = [(w, x, y, z), (-x, w, z, -y), (-y, -z, w, x), (-z, y, -x, w)]
    return min(max(abs(p - sign * q) for p, q in zip(form, b)) for form in forms for sign in (1, -1))


def differences(judge, ours, theirs, degree):
    """The largest difference by quantity."""
    stride = 14 + 3 * ((degree + 1) ** 2 - 1)
    found = dict.fromkeys(judge.largest if degree else list(judge.largest)[:-1], 0)
    size = max(max(ours[axis::stride]) - min(ours[axis::stride]) for axis in range(3))
    for a, b in pairs(ours, theirs, stride):
        if b is None:
            return {'position': math.inf}
        own = {
            'position': max(abs(p - q) for p, q in zip(a[:3], b)) / size,
            'size': max(abs(math.log(max(p, 1e-30) / max(q, 1e-30))) for p, q in zip(a[3:6], b[3:6])),
            'rotation': turn_between(a[6:10], b[6:10]),
            'opacity': abs(a[10] - b[10]),
            'colour': max(abs(p - q) for p, q in zip(judge.colors(a[11:14]), b[11:14])),
        }
        if degree:
            own['harmonics'] = max(abs(p - q) for p, q in zip(judge.harmonics(a[14:]), b[14:]))
        for name, value in own.items():
            found[name] = max(found[name], value)
    return found


with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as name:
    folder = Path(name)

    def run(*command):
        result = subprocess.run([str(part) for part in command], cwd=folder, capture_output=True, text=True)
        if result.returncode != 0:
            sys.exit(f'{" ".join(map(str, command))}\n{result.stdout}{result.stderr}')
        return result.stdout

    tureen, scene = arguments.tureen.resolve(), arguments.scene.resolve()
    packages = arguments.packages.resolve() if arguments.packages else folder
    if not arguments.packages:
        run('npm', 'install', '--silent', '--no-fund', '--no-audit', '--prefix', folder, *PACKAGES)
    modules = packages / 'node_modules'
    theirs = modules / '.bin/splat-transform'
    # One camera for all files: rounding moves the bounds, by which a camera would be chosen.
    bounds = json.loads(run(tureen, 'info', scene, '--json'))['bounds']
    middle = [(low + high) / 2 for low, high in zip(bounds['low'], bounds['high'])]
    size = max(high - low for low, high in zip(bounds['low'], bounds['high']))
    eye = [middle[0] + 0.8 * size, middle[1] - 0.5 * size, middle[2] - 1.2 * size]

    def image(path):
        target = folder / (path.name + '.png')
        run(tureen, 'render', path, '-o', target, '--size', '400x400', '--renderer', 'tiles', '--force',
            '--eye=' + ','.join(map(str, eye)), '--target=' + ','.join(map(str, middle)), '--fov', '40')
        return target

    def psnr(path, other):
        return json.loads(run(tureen, 'compare', image(path), image(other), '--json'))['psnr_db'] or math.inf

    def judge(what, path, other, least):
        found = psnr(path, other)
        report(found >= least, f'{what}: {found:.1f} dB, at least {least:.1f}')

    for extension in FORMATS:
        ours, other = folder / ('ours' + extension), folder / ('theirs' + extension)
        run(tureen, 'convert', scene, ours, '--no-measure', '--force')
        run(theirs, '-q', '-w', '-g', 'cpu', ours, 'back.ply')
        judge(f'splat-transform and Tureen read our {extension}', folder / 'back.ply', ours, ONE_STEP)
        run(theirs, '-q', '-w', '-g', 'cpu', scene, other)
        run(theirs, '-q', '-w', '-g', 'cpu', other, 'back.ply')
        judge(f'they read the {extension} of splat-transform', folder / 'back.ply', other, ONE_STEP)
        print(f'      loss of {ours.stat().st_size} bytes of ours {psnr(ours, scene):.1f} dB, of '
              f'{other.stat().st_size} bytes of theirs {psnr(other, scene):.1f} dB')
    # spz-js stops at version 2, which Tureen only reads. It keeps the axes of PLY, where Niantic's program and Tureen
    # turn by half a turn about x.
    (folder / 'two.mjs').write_text(f"""
import {{ readFileSync, writeFileSync }} from 'node:fs';
import {{ loadPly, loadSpz, serializePly, serializeSpz }} from '{modules}/spz-js/dist/index.js';
const spz = await serializeSpz(await loadPly(new Blob([readFileSync('{scene}')]).stream()));
writeFileSync('two.spz', spz);
writeFileSync('back.ply', new Uint8Array(serializePly(await loadSpz(spz))));
""")
    run('node', 'two.mjs')
    run(tureen, 'convert', 'two.spz', 'two.ply', '--rotate', '180,0,0')
    judge('spz-js and Tureen read the SPZ 2 of spz-js', folder / 'back.ply', folder / 'two.ply', ONE_STEP)
    # Tureen does not write .ksplat; GaussianSplats3D does: level 1 has 16 bits.
    (folder / 'ksplat.mjs').write_text(f"""
import {{ readFileSync, writeFileSync }} from 'node:fs';
import {{ PlyLoader }} from '{modules}/@mkkellogg/gaussian-splats-3d/build/gaussian-splats-3d.module.js';
globalThis.window = globalThis;  // it calls window.setTimeout
const ply = readFileSync('{scene}'), bytes = ply.buffer.slice(ply.byteOffset, ply.byteOffset + ply.length);
const splats = await PlyLoader.loadFromFileData(bytes, 1, 1, true, 2);
writeFileSync('ours.ksplat', new Uint8Array(splats.bufferData));
""")
    run('node', 'ksplat.mjs')

    tasks, results = queue.Queue(), queue.Queue()
    roots = {'packages': modules, 'files': folder, 'judges': Path(__file__).resolve().parent / 'judges'}
    server = ThreadingHTTPServer(('127.0.0.1', 0), partial(Server, roots=roots, tasks=tasks, results=results))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    program = os.environ.get('CHROMIUM') or shutil.which('chromium-headless-shell') or shutil.which('chromium')
    if not program:
        sys.exit('chromium is not installed; CHROMIUM=PATH sets another browser')
    browser = subprocess.Popen([program, '--headless', '--no-sandbox', '--disable-gpu', '--remote-debugging-port=0',
                                f'--user-data-dir={folder}/browser',
                                f'http://127.0.0.1:{server.server_port}/judges/judge.html'],
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    atexit.register(os.killpg, browser.pid, signal.SIGTERM)  # Debian's program is a script, whose child is the browser

    def in_browser(judge, file):
        """What the judge reads, or the error as text."""
        tasks.put({'judge': judge.name, 'file': file})
        try:
            degree, body = results.get(timeout=120)
        except queue.Empty:
            sys.exit(f'{judge.name} {file}: no result within 120 s')
        return body.decode() if degree is None else (int(degree), array('f', body))

    for extension in sorted({extension for judge in BROWSERS for extension in judge.formats}):
        file = folder / ('ours' + extension)
        if not file.exists():
            version = ['--spz-version', '3'] if extension == '.3.spz' else []
            run(tureen, 'convert', scene, file, '--no-measure', *version)
        read = {}
        for turned in (False, True):
            ply = folder / 'read.ply'
            run(tureen, 'convert', file, ply, '--force', *(['--rotate', '180,0,0'] if turned else []))
            read[turned] = splats_of_ply(ply)
        for judge in BROWSERS:
            if extension not in judge.formats:
                continue
            what = f'{judge.name} and Tureen read {file.name}'
            found = in_browser(judge, file.name)
            if isinstance(found, str):
                report(False, f'{what}: {found}')
                continue
            degree, ours = read[extension in judge.stored_axes]
            if found[0] != degree or len(found[1]) != len(ours):
                report(False, f'{what}: degree {found[0]} and {len(found[1])} values, instead of {degree} and {len(ours)}')
                continue
            largest = differences(judge, ours, found[1], degree)
            limits = {name: judge.known.get((extension, name), judge.largest[name]) for name in largest}
            bad = [name for name, value in largest.items() if limits[name] is not None and not value <= limits[name]]
            report(not bad, f'{what}: ' + ', '.join(f'{name} {value:.2g}' for name, value in largest.items())
                   + (f' (too large: {", ".join(bad)})' if bad else ''))

sys.exit(1 if wrong else 0)
