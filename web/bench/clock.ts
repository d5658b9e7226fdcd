// The browser's clock. Browsers limit its resolution, which determines the minimum length of a sample.

const looks = 20;

let step: number | null = null;

/** The smallest observed step of performance.now(), in milliseconds. */
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

/** "0.1 ms": two digits, because subtraction adds rounding errors. */
const stepText = () => `${Number(clockStepMs().toPrecision(2))} ms`;

export const clockSentence = (minSampleMs: number) =>
  `the browser's performance.now() with steps of ${stepText()}; a sample lasts at least ` +
  `${Number(minSampleMs.toPrecision(2))} ms, from an idle device until one pixel of the last frame is read back`;
