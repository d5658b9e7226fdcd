// Decodes a soup's texels while their file arrives (formats/early_texels.hpp). A second worker decodes, because the
// loader must receive the file; when the file is there, both do.

import { Engine } from './engine.js';
import type { FromLoader, TexelStrip, ToLoader } from './loader_messages.js';

/** The strips are in the first bytes of a file if its header is not larger. */
const maxHeader = 1 << 20;

/** A second worker of the same script. */
class Helper {
  private readonly worker = new Worker(self.location.href);
  private readonly tasks: { resolve(texels: Uint8Array): void; reject(why: unknown): void }[] = [];
  private works = false;  // it has started and has not failed

  constructor(program: Promise<WebAssembly.Module>) {
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.fail(event);
    };
    this.worker.onmessage = ({ data }: MessageEvent<FromLoader>) => {
      if (data.kind === 'started') this.works = true;
      else if (data.kind === 'decoded') this.tasks.shift()!.resolve(data.texels);
      else this.fail(data);
    };
    program.then((compiled) => this.send({ kind: 'help', program: compiled }), () => {});
  }

  /** Whether it can take another strip. A second one lets it work while the loader decodes. `left`: number of strips
   *  without a decoder; the last ones are shared evenly. */
  isFree(left: number): boolean { return this.works && this.tasks.length < (left > 2 ? 2 : 1); }

  decode(strip: TexelStrip, bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
    const decoded = new Promise<Uint8Array>((resolve, reject) => { this.tasks.push({ resolve, reject }); });
    this.send({ kind: 'decode', strip, bytes }, [bytes.buffer]);
    return decoded;
  }

  end(): void { this.worker.terminate(); }

  private fail(why: unknown): void {
    this.works = false;
    for (const { reject } of this.tasks) reject(why);
  }

  private send(message: ToLoader, transfer: Transferable[] = []): void { this.worker.postMessage(message, transfer); }
}

/** A strip takes a tenth of a second. After this time, a browser has ended the second worker without an event. */
const patienceMs = 10_000;

/** Lets the worker receive messages. */
const pause = (ms = 0) => new Promise((resolve) => { setTimeout(resolve, ms); });

export class EarlyTexels {
  /** Number of strips that the second worker decoded. */
  helped = 0;
  private strips: readonly TexelStrip[] | null = null;  // null before begin()
  /** The next strip without a decoder. */
  private next = 0;
  private helper: Helper | null = null;
  private helping: Promise<void> | null = null;
  /** The bytes so far. */
  private prefix: Uint8Array = new Uint8Array();

  /** `engine`: called when texels are decoded. */
  constructor(private readonly engine: () => Engine, private readonly program: Promise<WebAssembly.Module>) {}

  /** Starts the second worker, which takes a tenth of a second. */
  prepare(): void {
    try {
      this.helper ??= new Helper(this.program);
    } catch {}  // the browser allows no worker in a worker
  }

  /** Finds the strips once `prefix`, the first bytes of the file, has its whole header. `known`: it has. */
  begin(prefix: Uint8Array, known: boolean): void {
    if (this.strips || !(known || prefix.length >= maxHeader)) return;
    this.strips = [];
    try {
      this.engine().setBuffer(prefix.subarray(0, maxHeader));
      this.strips = this.engine().call<TexelStrip[]>('begin_texels');
      if (this.strips.length > 1) this.prepare();
    } catch {}  // the reader reports what is broken
  }

  /** Gives the second worker the next strips that are in `prefix`. */
  feed(prefix: Uint8Array): void {
    this.prefix = prefix;
    while (this.strips && this.helper?.isFree(this.strips.length - this.next)) {
      const taken = this.take();
      if (!taken) return;
      this.helping = this.helper.decode(taken.strip, new Uint8Array(taken.bytes)).then((texels) => {
        ++this.helped;
        this.engine().setBuffer(texels);
        this.engine().call('add_texels', taken.index);
        this.feed(this.prefix);
      }).catch(() => { this.next = Infinity; });  // the reader decodes what is missing
    }
  }

  /** Decodes all that is left. `bytes`: the whole file. `each`: called after each strip with the fraction done. */
  async finish(bytes: Uint8Array, each: (fraction: number) => Promise<void>): Promise<void> {
    try {
      this.begin(bytes, true);
      for (;;) {
        await pause();
        this.feed(bytes);
        const taken = this.take();
        if (!taken) break;
        this.engine().setBuffer(taken.bytes);
        this.engine().call('decode_texels', taken.index);
        await each(this.next / this.strips!.length);
      }
      for (let last: Promise<void> | null = null; last !== this.helping;)
        await Promise.race([last = this.helping, pause(patienceMs)]);
    } catch {
    } finally {
      this.helper?.end();
    }
  }

  /** Takes the next strip without a decoder; null if the bytes so far contain none. */
  private take(): { readonly index: number; readonly strip: TexelStrip; readonly bytes: Uint8Array } | null {
    const index = this.next, strip = this.strips?.[index];
    if (!strip || this.prefix.length < strip.high.offset + strip.high.size) return null;
    this.next = index + 1;
    return { index, strip, bytes: this.prefix.subarray(strip.low.offset, strip.high.offset + strip.high.size) };
  }
}

let engine: Engine | null = null;

/** In the second worker. */
export async function help(program: WebAssembly.Module): Promise<FromLoader> {
  engine = await Engine.create(program);
  return { kind: 'started' };
}

/** In the second worker, after help(). */
export function decoded(strip: TexelStrip, bytes: Uint8Array): FromLoader {
  engine!.setBuffer(bytes);
  engine!.call('decode_strip', strip);
  return { kind: 'decoded', texels: engine!.buffer().slice() };
}
