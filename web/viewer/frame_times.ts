// Frame times over the last second.

const window = 1000;  // milliseconds
/** Milliseconds; a longer pause is idle time, not a slow frame. */
const rest = 500;

export class FrameTimes {
  private readonly intervals: { at: number; ms: number }[] = [];
  private last: number | null = null;
  submitMs: number | null = null;

  /** Adds a frame drawn at this time. */
  add(now: number, submitMs: number): void {
    if (this.last !== null && now - this.last < rest) this.intervals.push({ at: now, ms: now - this.last });
    this.last = now;
    this.submitMs = submitMs;
    while (this.intervals.length > 0 && this.intervals[0]!.at < now - window) this.intervals.shift();
  }

  /** Clears the times when drawing stops. */
  stop(): void {
    this.intervals.length = 0;
    this.last = this.submitMs = null;
  }

  /** The percentile by nearest rank; null without frames. */
  percentile(percent: number): number | null {
    if (this.intervals.length === 0) return null;
    const sorted = this.intervals.map(({ ms }) => ms).sort((a, b) => a - b);
    return sorted[Math.ceil(percent / 100 * sorted.length) - 1]!;
  }
}
