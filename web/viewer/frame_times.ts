// How long frames take, of the last second.

const window = 1000;  // milliseconds
/** A longer pause is rest, not a slow frame. */
const rest = 500;

export class FrameTimes {
  private readonly intervals: { at: number; ms: number }[] = [];
  private last: number | null = null;
  submitMs: number | null = null;

  /** A frame was drawn at this time. */
  add(now: number, submitMs: number): void {
    if (this.last !== null && now - this.last < rest) this.intervals.push({ at: now, ms: now - this.last });
    this.last = now;
    this.submitMs = submitMs;
    while (this.intervals.length > 0 && this.intervals[0]!.at < now - window) this.intervals.shift();
  }

  /** Nothing more is drawn for now. */
  stop(): void {
    this.intervals.length = 0;
    this.last = this.submitMs = null;
  }

  /** Nearest rank; null at rest. */
  percentile(percent: number): number | null {
    if (this.intervals.length === 0) return null;
    const sorted = this.intervals.map(({ ms }) => ms).sort((a, b) => a - b);
    return sorted[Math.ceil(percent / 100 * sorted.length) - 1]!;
  }
}
