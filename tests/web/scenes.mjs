// Scenes by the native programs for several files of tests.

import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { programs, source } from './browser.mjs';

let folder = null;

/** The folder of the goldens' scenes; made once for all files that run. */
export function goldenScenes() {
  if (folder) return folder;
  folder = mkdtempSync(join(tmpdir(), 'tureen-goldens-'));
  process.on('exit', () => rmSync(folder, { recursive: true, force: true }));
  execFileSync(join(programs, 'make_golden_scenes'), [join(source, 'examples/soup.glb'), folder]);
  return folder;
}

/** A square in the plane z = 0 with its centre at the origin, of one colour. */
export const square = (side, color) => `ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
element face 2
property list uchar int vertex_indices
end_header
${[[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => `${x * side / 2} ${y * side / 2} 0 ${color}`).join('\n')}
3 0 1 2
3 0 2 3
`;
