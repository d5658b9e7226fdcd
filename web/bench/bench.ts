// bench.html: measures the time this device needs to draw scenes, with the viewer's pipeline.
// The address has the settings (request.ts), and the form sends them to the page. The result is also in
// window.tureenBench, for programs that drive the page.

import { block, button, fillFacts, input, make, saveFile } from '../common/dom.js';
import { readModels } from '../common/gallery.js';
import { Messages } from '../common/messages.js';
import { ViewerError } from '../viewer/types.js';
import { BenchEngine } from './bench_engine.js';
import { benchFile, type BenchFile } from './bench_file.js';
import { Measuring } from './measure.js';
import { readAddress, setName, type BenchRequest } from './request.js';
import { showResults } from './results.js';

declare global {
  interface Window {
    /** The result of the measurement. Rejects if it fails; stays pending if the address asks for none. */
    tureenBench: Promise<BenchFile>;
  }
}

const messages = new Messages();

/** Shows the request in the form. */
async function fill(request: BenchRequest): Promise<void> {
  const { scenes, cameras, sizes, rounds, published, grid, copies } = request;
  const urls = scenes.length ? scenes : (await readModels()).slice(0, 1);
  input('scenes').value = urls.map(({ url }) => url).join(',');
  input('set').value = setName(cameras);
  input('size').value = sizes.map(({ width, height }) => `${width}x${height}`).join(',');
  input('rounds').value = String(rounds);
  input('published').checked = published;
  input('grid').checked = grid;
  input('copies').value = String(copies);
}

async function start(): Promise<BenchEngine> {
  const canvas = make('canvas', { 'aria-label': 'Measured image', role: 'img', hidden: true });
  const engine = await BenchEngine.start(canvas);
  block('image').append(canvas);
  const { renderer, limits } = engine.device;
  fillFacts(block('device'), [['Renderer', renderer], ['Pixel ratio', String(devicePixelRatio)]]);
  block('software').hidden = !limits.software;
  return engine;
}

function tell(what: string, fraction: number): void {
  const percent = Math.round(100 * fraction);
  if (block('what').textContent !== what) block('what').textContent = what;  // screen readers read every change
  block('progress').setAttribute('aria-valuenow', String(percent));
  block('progress-bar').style.width = `${percent}%`;
}

async function measure(engine: BenchEngine, request: BenchRequest): Promise<BenchFile> {
  if (request.scenes.length === 0) throw new ViewerError('There is no scene to measure: enter its address.', 'usage');
  const cancelled = new AbortController();
  button('cancel').addEventListener('click', () => cancelled.abort());
  block('under-way').hidden = false;
  try {
    const scenes = await new Measuring(engine, request, cancelled.signal, tell).run();
    const file = benchFile(engine.device, scenes);
    button('save-json').addEventListener('click', () => saveFile(
      `tureen-bench-${file.date.replaceAll(':', '')}.json`,
      new Blob([JSON.stringify(file, null, 1) + '\n'], { type: 'application/json' })));
    showResults(scenes);
    block('results').focus();
    return file;
  } catch (error) {
    if (cancelled.signal.aborted) messages.notice('The measurement was cancelled.');
    throw error;
  } finally {
    block('under-way').hidden = true;
  }
}

async function open(): Promise<BenchFile> {
  const request = readAddress(location.search);
  await fill(request);
  const engine = await start();
  return request.run ? measure(engine, request) : new Promise(() => {});
}

window.addEventListener('error', (event) => messages.thrown(event.error ?? event.message));
window.addEventListener('unhandledrejection', (event) => messages.thrown(event.reason));
window.tureenBench = open();
window.tureenBench.catch((error: unknown) => messages.thrown(error));
