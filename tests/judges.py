#!/usr/bin/env python3
"""Judges that are not ours: @playcanvas/splat-transform reads what Tureen writes, and Tureen reads what it and spz-js
write. Two readers of one file must agree: their images differ by at most one 8-bit step a value, 48.1 dB, since readers
only decode. For development; needs Node 20 and npm.

    tests/judges.py [--tureen build/release/bin/tureen] [--scene tests/formats/data/splat_transform.ply]"""

import argparse
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

PACKAGES = ['@playcanvas/splat-transform@2.7.1', 'spz-js@1.2.5']
FORMATS = ['.sog', '.spz', '.compressed.ply', '.ply']
ONE_STEP = 20 * math.log10(255)  # PSNR of images that differ by one step everywhere

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument('--tureen', default='build/release/bin/tureen', type=Path)
parser.add_argument('--scene', default='tests/formats/data/splat_transform.ply', type=Path, help='Gaussians in a PLY')
parser.add_argument('--packages', type=Path, help='a folder with the packages; default: npm installs them')
arguments = parser.parse_args()
wrong = 0

with tempfile.TemporaryDirectory() as name:
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
    theirs = packages / 'node_modules/.bin/splat-transform'
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
        global wrong
        found = psnr(path, other)
        passed = found >= least
        wrong += not passed
        print(f'{"ok   " if passed else "WRONG"} {what}: {found:.1f} dB, at least {least:.1f}', flush=True)

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
import {{ loadPly, loadSpz, serializePly, serializeSpz }} from '{packages}/node_modules/spz-js/dist/index.js';
const spz = await serializeSpz(await loadPly(new Blob([readFileSync('{scene}')]).stream()));
writeFileSync('two.spz', spz);
writeFileSync('back.ply', new Uint8Array(serializePly(await loadSpz(spz))));
""")
    run('node', 'two.mjs')
    run(tureen, 'convert', 'two.spz', 'two.ply', '--rotate', '180,0,0')
    judge('spz-js and Tureen read the SPZ 2 of spz-js', folder / 'back.ply', folder / 'two.ply', ONE_STEP)

sys.exit(1 if wrong else 0)
