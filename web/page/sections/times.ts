// Frame times, in the panel and over the image. The page draws no frames while the view is idle.

import type { FrameStats, Viewer } from '../../viewer/types.js';
import { block, fillFacts, input } from '../../common/dom.js';
import { recall, remember } from '../memory.js';
import { bytesText, millisecondsText } from '../../common/numbers.js';

/** Time between updates: short enough to follow, long enough to read. */
const everyMs = 250;

export class TimesSection {
  private readonly readout = block('readout');
  private readonly shown = input('show-readout');
  private waiting = false;

  constructor(private readonly viewer: Viewer) {
    this.shown.checked = recall('readout') !== false;
    this.shown.addEventListener('change', () => {
      remember('readout', this.shown.checked);
      this.update();
    });
    viewer.on('frame', () => this.updateSoon());
    viewer.on('scene', () => this.update());
    this.update();
  }

  private updateSoon(): void {
    if (this.waiting) return;
    this.waiting = true;
    setTimeout(() => {
      this.waiting = false;
      this.update();
      if (this.viewer.stats.frameMs !== null) this.updateSoon();  // until the view is idle
    }, everyMs);
  }

  private update(): void {
    const stats = this.viewer.stats;
    const { frameMs, p95Ms, submitMs, width, height, scale } = stats;
    const size = `${width} × ${height}`;
    fillFacts(block('times-facts'), [
      ['Frame interval',
       frameMs === null ? 'idle' : `${millisecondsText(frameMs)}, ${(1000 / frameMs).toFixed(0)} per second`],
      ['Slowest 5 %', p95Ms === null ? null : `over ${millisecondsText(p95Ms)}`],
      ['Submission', submitMs === null ? null : millisecondsText(submitMs)],
      ['Resolution', `${size}, ${scale.toFixed(2)} × screen`],
      ['WebAssembly', bytesText(stats.wasmBytes)],
      ['Renderer', stats.renderer],
    ]);
    block('resolution-now').textContent = `Current resolution: ${size}.`;
    this.readout.hidden = !this.shown.checked || !this.viewer.scene;
    this.readout.textContent = this.short(stats, size);
  }

  private short({ frameMs }: FrameStats, size: string): string {
    return `${frameMs === null ? 'idle' : millisecondsText(frameMs)} · ${size}`;
  }
}
