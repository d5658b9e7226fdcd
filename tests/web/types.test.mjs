// esbuild removes types without a check, so this checks them.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { join } from 'node:path';
import { source, test } from './support.mjs';

test('the page\'s TypeScript has no type errors', () => {
  const web = join(source, 'web');
  const { status, stdout, stderr } = spawnSync(join(web, 'node_modules/.bin/tsc'), ['--noEmit', '-p', web], { encoding: 'utf8' });
  assert.equal(status, 0, stdout + stderr);
});
