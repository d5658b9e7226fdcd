#!/usr/bin/env python3
"""Judges that are not ours: @playcanvas/splat-transform and spz-js read what Tureen writes, and Tureen reads what they
write; images must agree within the rounding of the format. For development; needs Node 20 and npm.

    tests/judges.py [--tureen build/release/bin/tureen] [--scene tests/formats/data/splat_transform.ply]"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

PACKAGES = ['@playcanvas/splat-transform@2.7.1', 'spz-js@1.2.5']
# Least PSNR of a view, in dB: two roundings of the format, with the margin of one bit. The loss of one rounding is what
# `tureen convert` prints.
FORMATS = {'.sog': 30, '.spz': 30, '.compressed.ply': 30}

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument('--tureen', default='build/release/bin/tureen', type=Path)
parser.add_argument('--scene', default='tests/formats/data/splat_transform.ply', type=Path, help='Gaussians in a PLY')
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
    run('npm', 'install', '--silent', '--no-fund', '--no-audit', '--prefix', folder, *PACKAGES)
    theirs = folder / 'node_modules/.bin/splat-transform'
    camera = folder / 'camera.json'
    camera.write_text(json.dumps({'cameras': json.loads(run(tureen, 'info', scene, '--json'))['cameras']}))

    def image(path):
        target = folder / (path.name + '.png')
        run(tureen, 'render', path, '-o', target, '--size', '400x400', '--renderer', 'tiles', '--force')
        return target

    def judge(what, path, least):
        global wrong
        found = json.loads(run(tureen, 'compare', image(path), expected, '--json'))['psnr_db']
        passed = found >= least
        wrong += not passed
        print(f'{"ok   " if passed else "WRONG"} {what}: {found:.1f} dB, at least {least}')

    expected = image(scene)
    for extension, least in FORMATS.items():
        run(tureen, 'convert', scene, 'ours' + extension, '--no-measure', '--force')
        run(theirs, '-q', '-w', '-g', 'cpu', 'ours' + extension, 'back.ply')
        judge(f'splat-transform reads our {extension}', folder / 'back.ply', least)
        run(theirs, '-q', '-w', '-g', 'cpu', scene, 'theirs' + extension)
        judge(f'Tureen reads the {extension} of splat-transform', folder / ('theirs' + extension), least)

    # spz-js reads version 3 and older.
    run(tureen, 'convert', scene, 'three.spz', '--spz-version', '3', '--no-measure')
    (folder / 'read.mjs').write_text("""
import { readFileSync, writeFileSync } from 'node:fs';
import { loadSpz, serializeSpz } from 'spz-js';
const cloud = await loadSpz(readFileSync('three.spz'));
console.log(cloud.numPoints);
writeFileSync('again.spz', Buffer.from(await serializeSpz(cloud)));
""")
    points = int(run('node', 'read.mjs'))
    print(f'ok    spz-js reads our SPZ 3: {points} splats')
    judge('Tureen reads the SPZ of spz-js', folder / 'again.spz', FORMATS['.spz'])

sys.exit(1 if wrong else 0)
