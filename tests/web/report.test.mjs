// The report page in a browser: each kind of result shows its tables and plots, and no content causes an error.

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { each, programs, scratch, source, stage, test } from './support.mjs';

const folder = scratch();
const { visit } = await stage({ folder });

const fixture = (name) => readFileSync(join(source, 'tests', name), 'utf8');
const hostile = '</script><img src=x onerror=alert(1)>';
const record = (step) => JSON.stringify({ step, seconds: step / 10, loss: 1 / step, l1: 0.1, ssim: 0.8, train_psnr_db: 20, ...(step % 100 ? {} : { test_psnr_db: 21.5 }), triangles: 100, it_per_second: 10, non_finite: 0 });
const log = [50, 100, 150, 200].map((step) => `${record(step)}\n`).join('');
const tradeoff = JSON.parse(fixture('cli/tradeoff.json'));
const evaluation = { views: ['a', hostile].map((name) => ({ name, psnr_db: 30, ssim: 0.9 })), mean: { psnr_db: 30.125, ssim: 0.9 }, split: 'test', ssim_border: 'valid', output: ['views/a b.png', 'views/b.png'] };
const measurements = {
  format: 'tureen measurements', version: 1, name: hostile, machine: { cpu: 'a processor', cores: 2 },
  tables: { cases: [{ case: hostile, margin: 2 }], points: [1, 10, 100].map((at) => ({ case: 'G1', at, ours: at, naive: null })) },
  plots: [{ table: 'points', x: 'at', y: ['ours', 'naive'], each: 'case' }],
};

// For each kind: the files, the words in the page, and the least number of tables and plots.
const kinds = {
  bench: { files: { 'phone.json': fixture('jobs/web_bench.json') }, words: ['Adreno (TM) 740'], tables: 1, plots: 1 },
  'several benches': { files: { 'phone.json': fixture('jobs/web_bench.json'), 'laptop.json': fixture('jobs/web_bench.json').replace('Adreno (TM) 740', 'llvmpipe') }, words: ['phone (ms)', 'laptop (ms)', 'llvmpipe'], tables: 3, plots: 2 },
  tradeoff: { files: { 'tradeoff.json': JSON.stringify({ ...tradeoff, scene: { ...tradeoff.scene, name: hostile } }) }, words: [hostile, '5.00×'], tables: 4, plots: 2 },
  'several tradeoffs': { files: { 'lego.json': JSON.stringify(tradeoff), 'chair.json': JSON.stringify({ ...tradeoff, scene: { ...tradeoff.scene, name: 'chair' } }) }, words: ['chair (dB)', 'lego (dB)'], tables: 6, plots: 6 },
  training: { files: { 'lego.jsonl': log }, words: ['21.50 dB'], tables: 1, plots: 3 },
  'several trainings': { files: { 'a.jsonl': log, 'b.jsonl': log }, words: ['a', 'b'], tables: 1, plots: 3 },
  eval: { files: { 'eval.json': JSON.stringify(evaluation) }, words: ['30.13 dB', hostile], tables: 1, plots: 1, images: 2 },
  measurements: { files: { 'measured.json': JSON.stringify(measurements) }, words: [hostile, 'points'], tables: 2, plots: 1 },
};

function report(files) {
  const paths = Object.entries(files).map(([name, text]) => {
    writeFileSync(join(folder, name), text);
    return join(folder, name);
  });
  execFileSync(join(programs, 'tureen'), ['report', ...paths, '-o', join(folder, 'page.html')], { stdio: 'ignore' });
  return readFileSync(join(folder, 'page.html'), 'utf8');
}

const chart = /<script>\s*\/\*!\s*\* Chart\.js[^]*?<\/script>/;

/** Tests on one page, by kind: with plots and without. Files that reports name are missing. */
const tests = [];
for (const [kind, { files, words, tables, plots, images = 0 }] of Object.entries(kinds)) {
  let html = '';
  const shows = (library) => async (page, part) => {
    html ||= report(files);
    if (library && !chart.test(html)) return part.skip('chart.js is not installed');
    writeFileSync(join(folder, 'page.html'), library ? html : html.replace(chart, ''));
    await page.reload();
    const text = await page.locator('body').innerText();
    for (const word of words) assert.ok(text.includes(word), word);
    assert.deepEqual(await page.locator('.error').allTextContents(), []);
    assert.ok(await page.locator('table').count() >= tables);
    assert.equal(await page.locator('canvas').count() > 0, library);
    if (library) assert.ok(await page.locator('canvas').count() >= plots);
    assert.equal(await page.locator('figure img').count(), images);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth > innerWidth), false);
  };
  tests.push([`${kind}, with plots`, shows(true)], [`${kind}, without plots`, shows(false)]);
}

writeFileSync(join(folder, 'page.html'), '<!doctype html><html lang="en"><title>Report</title><link rel="icon" href="data:,">');
test('each kind', (context) => visit('page.html', (page) => each(context, tests, page),
                                     { viewport: { width: 390, height: 800 }, expected: [/Failed to load resource/] }));
