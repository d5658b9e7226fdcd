// bench.html: measures the time this device needs to draw scenes, with the viewer's pipeline.
// A link can set everything (request.ts). The result is also in window.tureenBench, for programs that
// drive the page.

import { block, button, fillFacts, make, saveFile } from '../common/dom.js';
import { Messages } from '../common/messages.js';
import { BenchEngine } from './bench_engine.js';
import { benchCsv, benchFile, type BenchFile } from './bench_file.js';
import { Measuring, type MeasuredScene } from './measure.js';
import { readAddress, writeAddress, type AddressRequest, type BenchRequest } from './request.js';
import { showResults } from './results.js';
import { Settings } from './settings.js';

declare global {
  interface Window {
    /** The result of the latest measurement, or of the first before one begins. Rejects if it fails. */
    tureenBench: Promise<BenchFile>;
  }
}

class Bench {
  private readonly messages = new Messages();
  private readonly settings = new Settings(
    this.messages, (request) => void this.measure(request), (error) => this.fail(error));
  private engine: BenchEngine | null = null;
  private current: AbortController | null = null;
  private outcome: { file: BenchFile; scenes: readonly MeasuredScene[] } | null = null;
  private measurements = 0;
  private promise!: { resolve(file: BenchFile): void; reject(why: unknown): void };

  constructor() {
    window.addEventListener('error', (event) => this.messages.thrown(event.error ?? event.message));
    window.addEventListener('unhandledrejection', (event) => this.messages.thrown(event.reason));
    button('cancel').addEventListener('click', () => this.current?.abort());
    button('save-json').addEventListener('click', () => this.save('json'));
    button('save-csv').addEventListener('click', () => this.save('csv'));
    this.promiseResult();
  }

  async open(): Promise<void> {
    const asked = this.asked();
    await this.settings.fill(asked);
    try {
      await this.start();
    } catch (error) {
      return this.fail(error);
    }
    this.settings.ready = true;
    if (asked.run) this.settings.submit();
  }

  private asked(): AddressRequest {
    try {
      return readAddress(location.search);
    } catch (error) {
      this.fail(error);
      return readAddress('');
    }
  }

  /** Reports the error on the page and to the program that drives it. */
  private fail(error: unknown): void {
    this.messages.thrown(error);
    this.promise.reject(error);
  }

  /** An engine on its own canvas. Replaces an engine with a lost context. */
  private async start(): Promise<BenchEngine> {
    if (this.engine && !this.engine.isLost) return this.engine;
    this.engine?.canvas.remove();
    const canvas = make('canvas', { 'aria-label': 'Measured image', role: 'img', hidden: true });
    this.engine = await BenchEngine.start(canvas);
    block('image').append(canvas);
    const { renderer, limits } = this.engine.device;
    fillFacts(block('device'), [['Renderer', renderer], ['Pixel ratio', String(devicePixelRatio)]]);
    block('software').hidden = !limits.software;
    return this.engine;
  }

  private async measure(request: BenchRequest): Promise<void> {
    if (this.current) return;
    const mine = this.current = new AbortController();
    if (this.measurements++ > 0) this.promiseResult();
    const address = writeAddress(request);
    history.replaceState(null, '', address ?? location.pathname);
    this.busy = true;
    try {
      const engine = await this.start();
      const tell = (what: string, fraction: number) => this.tell(what, fraction);
      const scenes = await new Measuring(engine, request, mine.signal, tell).run();
      this.show({ file: benchFile(engine.device, scenes), scenes });
    } catch (error) {
      if (mine.signal.aborted) this.messages.notice('The measurement was cancelled.');
      else this.messages.thrown(error);
      this.promise.reject(error);
    } finally {
      this.current = null;
      this.busy = false;
    }
  }

  private set busy(busy: boolean) {
    this.settings.busy = busy;
    block('under-way').hidden = !busy;
    if (!busy) return;
    this.tell('starting', 0);
    button('cancel').focus();
  }

  private tell(what: string, fraction: number): void {
    const percent = Math.round(100 * fraction);
    if (block('what').textContent !== what) block('what').textContent = what;  // screen readers read every change
    block('progress').setAttribute('aria-valuenow', String(percent));
    block('progress-bar').style.width = `${percent}%`;
  }

  private show(outcome: NonNullable<typeof this.outcome>): void {
    this.outcome = outcome;
    showResults(outcome.scenes);
    block('results').focus();
    this.promise.resolve(outcome.file);
  }

  private save(kind: 'json' | 'csv'): void {
    const { file, scenes } = this.outcome!;
    const name = `tureen-bench-${file.date.replaceAll(':', '')}.${kind}`;
    const content = kind === 'json' ? JSON.stringify(file, null, 1) + '\n' : benchCsv(file, scenes);
    saveFile(name, new Blob([content], { type: kind === 'json' ? 'application/json' : 'text/csv' }));
  }

  private promiseResult(): void {
    window.tureenBench = new Promise((resolve, reject) => { this.promise = { resolve, reject }; });
    window.tureenBench.catch(() => {});  // the page shows the error
  }
}

void new Bench().open();
