// bench.html, started by a link; and `tureen report` with its result.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { each, often, programs, scratch, stage, test, thorough } from './support.mjs';

const { visit, server } = await stage();
const folder = scratch();

/** The result of the page. Polled, because a pending question to a page that never answers has no
 *  timeout. */
async function measured(page) {
  await page.waitForFunction(() => {
    void window.tureenBench.then((file) => { window.benchFile = file; }, (error) => { window.benchFile = { error: String(error) }; });
    return window.benchFile;
  }, null, often);
  const file = await page.evaluate(() => window.benchFile);
  assert.equal(file.error, undefined);
  return file;
}

const small = 'set=hemisphere:2&size=160x90&rounds=2&run=1';
const both = `bench.html?scenes=soup.glb&published=1&${small}`;

const hashes = (file) => file.scenes[0].measurements[0].entrants.map(({ pixels_hash }) => pixels_hash);

const tests = [
  ['a link measures, and the program reads the result', (page, result) => {
    const [scene] = result.scenes, [measurement] = scene.measurements;
    assert.equal(scene.triangles, 7000);
    assert.deepEqual(measurement.entrants.map(({ configuration }) => configuration), ['tureen', 'published']);
    for (const { frame_ms } of measurement.entrants) {
      assert.equal(frame_ms.length, 2, 'two rounds');
      assert.ok(frame_ms.every((round) => round.length === 2 && round.every((ms) => ms > 0)));
    }
    assert.match(result.device.renderer, /llvmpipe/);
    assert.ok(result.device.software);

    const file = join(folder, 'browser.json'), shown = join(folder, 'report.html');
    writeFileSync(file, JSON.stringify(result));
    execFileSync(join(programs, 'tureen'), ['report', file, '-o', shown], { stdio: 'ignore' });
    assert.ok(readFileSync(shown, 'utf8').includes(measurement.entrants[0].pixels_hash), 'the same pixels');
  }],
  ['two rounds of two views have neither a ratio nor a 99th percentile', async (page) => {
    const cells = await page.locator('#times tbody tr').last().locator('td').allInnerTexts();
    assert.deepEqual(cells.slice(2, 5), ['–', '–', '2 rounds']);
  }],
  ['both pipelines draw the same scene, each time the same pixels', async (page, result) => {
    await page.goto(new URL(both, server.address).href);
    assert.deepEqual(hashes(await measured(page)), hashes(result));
  }],
];
thorough('a link that measures twice', (context) => visit(both, async (page) => each(context, tests, page, await measured(page))));

const onGrid = (copies, maxBytes) => () => visit(`bench.html?scenes=soup.glb&grid=1&copies=${copies}&${small}`, async (page) => {
  const { scenes } = await measured(page);
  const grid = scenes.find(({ configurations }) => configurations.some(({ name }) => name === 'grid'));
  assert.ok(grid, 'the grid is measured');
  assert.ok(grid.wasm_bytes < maxBytes, `bytes of WebAssembly: ${grid.wasm_bytes}`);
});
test('three models on a grid', onGrid(3, 32e6));
thorough('fourteen models fit on a grid', onGrid(14, 64e6));

test('the form measures what its fields name', () => visit('bench.html?set=hemisphere:1&size=16x16&rounds=1&published=0', async (page) => {
  await page.waitForFunction(() => document.getElementById('scenes').value === 'soup.glb', null, often);  // the gallery's
  await page.fill('#set', 'orbit:1');
  await page.click('button:has-text("Measure")');
  await page.waitForURL(/run=1/);
  const { scenes: [{ configurations, measurements: [{ camera_set, width }] }] } = await measured(page);
  assert.deepEqual([configurations.length, camera_set, width], [1, 'orbit:1', 16]);
}));

test('a missing scene is reported', () => visit(`bench.html?scenes=nowhere.glb&${small}`, async (page) => {
  await page.locator('[role=alert]', { hasText: 'nowhere.glb' }).waitFor();
}, { expected: [/404/] }));
