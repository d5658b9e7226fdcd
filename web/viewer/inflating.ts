// The browser inflates zlib streams: in WebAssembly, this takes several times as long.

import type { Deflated, FromLoader, Inflated, ToLoader } from './loader_messages.js';

/** Whether the browser has a decompressor. */
export const canInflate = () => typeof DecompressionStream !== 'undefined';

/** Rejects if a stream is damaged or has another size. */
export const inflate = (streams: readonly Deflated[]): Promise<Inflated> =>
  Promise.all(streams.map(inflateOne)).then((parts) => parts.flat());

/** A browser inflates what is written at once, before its size is checked: at most 1032 times as much. */
const writtenBytes = 1 << 16;

async function inflateOne({ pieces, size }: Deflated): Promise<Inflated> {
  const { readable, writable } = new DecompressionStream('deflate');
  const writer = writable.getWriter();
  const written = (async () => {
    for (const piece of pieces)
      for (let at = 0; at < piece.length; at += writtenBytes) await writer.write(piece.subarray(at, at + writtenBytes));
    await writer.close();
  })();
  written.catch(() => {});  // read() rejects, too
  const reader = readable.getReader(), inflated: Uint8Array<ArrayBuffer>[] = [];
  for (let left = size;;) {
    const { done, value } = await reader.read();
    if (done && left === 0) return inflated;
    left -= value?.length ?? 0;
    if (done || left < 0) {
      reader.cancel().catch(() => {});
      throw new RangeError(`not ${size} bytes`);
    }
    inflated.push(value!);
  }
}

/** A task takes a twentieth of a second. After this time, a browser has ended the second worker without an event. */
const patienceMs = 10_000;

/** A second worker of the same script. */
export class SecondInflater {
  private readonly worker = new Worker(self.location.href, { name: 'inflater' });
  private readonly tasks: { resolve(inflated: Inflated): void; reject(why: unknown): void }[] = [];
  private works = false;

  constructor() {
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.fail(event);
    };
    this.worker.onmessage = ({ data }: MessageEvent<FromLoader>) => {
      if (data.kind === 'inflated') this.tasks.shift()!.resolve(data.inflated);
      else this.fail(data);
    };
    this.inflate([]).then(() => { this.works = true; }, () => {});
  }

  /** Whether it can take another task. A second one lets it work while its caller is busy. */
  get isFree(): boolean { return this.works && this.tasks.length < 2; }

  /** Copies the streams. Rejects as inflate() does, and if the worker fails. */
  async inflate(streams: readonly Deflated[]): Promise<Inflated> {
    const copies = streams.map(({ pieces, size }) => ({ pieces: pieces.map((piece) => new Uint8Array(piece)), size }));
    const inflated = new Promise<Inflated>((resolve, reject) => { this.tasks.push({ resolve, reject }); });
    const task: ToLoader = { kind: 'inflate', streams: copies };
    this.worker.postMessage(task, copies.flatMap(({ pieces }) => pieces.map(({ buffer }) => buffer)));
    const timer = setTimeout(() => this.fail('no answer'), patienceMs);
    return inflated.finally(() => clearTimeout(timer));
  }

  end(): void { this.worker.terminate(); }

  private fail(why: unknown): void {
    this.works = false;
    for (const { reject } of this.tasks) reject(why);
  }
}
