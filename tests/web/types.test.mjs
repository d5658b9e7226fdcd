// esbuild drops types without a look at them, so they are checked here.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { join } from 'node:path';
import { test } from 'node:test';
import { source } from './browser.mjs';

test('all TypeScript of the page is of the types that it says', () => {
  const web = join(source, 'web');
  const { status, stdout, stderr } = spawnSync(join(web, 'node_modules/.bin/tsc'), ['--noEmit', '-p', web], { encoding: 'utf8' });
  assert.equal(status, 0, stdout + stderr);
});
