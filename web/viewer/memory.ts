// The memory that a scene may use. Browsers do not report it exactly, and end pages that use too much.

const gibibyte = 2 ** 30;

/** In bytes: 3 GiB. The loader holds about half of it, and its WebAssembly memory ends at 2 GiB. On phones a quarter of the
 *  device's memory (Chrome reports at most 8 GiB; 4 GiB if the browser reports none). */
export function defaultMemory(): number {
  const isPhone = matchMedia('(pointer: coarse)').matches && !matchMedia('(any-pointer: fine)').matches;
  const { deviceMemory = 4 } = navigator as { readonly deviceMemory?: number };
  return isPhone ? deviceMemory / 4 * gibibyte : 3 * gibibyte;
}
