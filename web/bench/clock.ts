// The browser's clock, which is made coarse on purpose: how coarse decides how long a sample must be.

const looks = 20;

let step: number | null = null;

/** The smallest step that performance.now() was seen to make, in milliseconds. */
export function clockStepMs(): number {
  if (step !== null) return step;
  step = Infinity;
  for (let look = 0; look < looks; ++look) {
    const before = performance.now();
    let now = before;
    while (now === before) now = performance.now();
    step = Math.min(step, now - before);
  }
  return step;
}

/** "0.1 ms": without the digits that come of subtracting. */
const stepText = () => `${Number(clockStepMs().toPrecision(2))} ms`;

export const clockSentence = (minSampleMs: number) =>
  `the browser's performance.now(), which steps by ${stepText()} here; a sample lasts at least ` +
  `${Number(minSampleMs.toPrecision(2))} ms, from an idle device until one pixel of the last frame was read back`;
