// The ratio of drawn pixels to screen pixels: fixed, or adapted to a frame rate.

import { ViewerError, type Resolution } from './types.js';

const lowestScale = 0.25, highestScale = 2;
/** Number of frames in a measurement of a scale. The first one is slow because it creates new targets. */
const settling = 8;
/** The scale changes only if the frame time is outside these factors of the target time. Displays have
 *  their own frame rate, and an oscillating scale is worse than a slightly low one. */
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
      throw new ViewerError(`The resolution ${asked} is invalid: it must be a factor or a frame rate above 0.`, 'usage');
    if (typeof value === 'number') this.current = Math.min(Math.max(value, lowestScale), highestScale);
    else this.current = Math.min(this.current, 1);
    this.asked = typeof value === 'number' ? this.current : value;
    this.recent.length = 0;
  }

  get scale(): number { return this.current; }

  /** Adds an interval between two consecutive frames. */
  add(ms: number): void {
    if (typeof this.asked === 'number') return;
    this.recent.push(ms);
    if (this.recent.length < settling) return;
    const sorted = [...this.recent].sort((a, b) => a - b), median = sorted[sorted.length >> 1]!;
    this.recent.length = 0;
    const wanted = 1000 / this.asked.targetFps, before = this.current;
    if (median > slack.over * wanted || median < slack.under * wanted)
      // Time is proportional to the pixels, so the side is proportional to its root. The scale has steps of 1/20.
      this.current = Math.round(20 * Math.min(Math.max(before * Math.sqrt(wanted / median), lowestScale), 1)) / 20;
  }
}
