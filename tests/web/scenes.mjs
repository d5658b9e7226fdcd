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
