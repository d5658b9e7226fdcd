/** Resolves when the condition holds. */
export async function until(holds, maxMs = 60_000) {
  const start = performance.now();
  while (!holds()) {
    if (performance.now() - start > maxMs) throw new Error(`The viewer did not reach this in ${maxMs} ms: ${holds}`);
    await new Promise((resolve) => setTimeout(resolve, 1));
  }
}
