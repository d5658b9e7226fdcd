// How many pixels are drawn for each of the screen's: as asked, or as many as hold a frame rate.

import { ViewerError, type Resolution } from './types.js';

const lowestScale = 0.25, highestScale = 2;
/** Frames that a new scale is looked at before it is judged: the first one makes new targets. */
const settling = 8;
/** Between so much less and more of the time that a frame may take nothing changes: displays have
 *  their own rhythm, and a scale that swings is worse than one that is a little low. */
const slack = { over: 1.15, under: 0.6 };

export class ResolutionKeeper {
  private asked: Resolution = 1;
  private current = 1;
  private readonly recent: number[] = [];

  get resolution(): Resolution { return this.asked; }
  /** Throws ViewerError. */
  set resolution(value: Resolution) {
    const asked = typeof value === 'number' ? value : value.targetFps;
    if (!(asked > 0 && asked < Infinity))
      throw new ViewerError(`A resolution is a factor or a rate of frames above 0, not ${asked}.`, 'usage');
    if (typeof value === 'number') this.current = Math.min(Math.max(value, lowestScale), highestScale);
    else this.current = Math.min(this.current, 1);
    this.asked = typeof value === 'number' ? this.current : value;
    this.recent.length = 0;
  }

  get scale(): number { return this.current; }

  /** An interval between two frames that followed each other. */
  add(ms: number): void {
    if (typeof this.asked === 'number') return;
    this.recent.push(ms);
    if (this.recent.length < settling) return;
    const sorted = [...this.recent].sort((a, b) => a - b), median = sorted[sorted.length >> 1]!;
    this.recent.length = 0;
    const wanted = 1000 / this.asked.targetFps, before = this.current;
    if (median > slack.over * wanted || median < slack.under * wanted)
      // Time goes with the pixels, so the side with its root; in steps that can be told apart.
      this.current = Math.round(20 * Math.min(Math.max(before * Math.sqrt(wanted / median), lowestScale), 1)) / 20;
  }
}
