// Decodes a soup's texels while their file arrives (formats/early_texels.hpp): every second strip in another worker,
// because strips are independent images and most computers have several cores.

import { Engine } from './engine.js';
import type { FromLoader, TexelStrip, ToLoader } from './loader_messages.js';

/** The strips are in the first bytes of a file if its header is not larger. */
const maxHeader = 1 << 20;

/** A second worker of the same script. */
class Helper {
  private readonly worker = new Worker(self.location.href);
  private settle: { resolve(texels: Uint8Array): void; reject(why: unknown): void } | null = null;
  /** Whether it can decode: it has started, is idle, and has not failed. */
  ready = false;

  constructor(program: Promise<WebAssembly.Module>) {
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.ready = false;
      this.settle?.reject(event);
    };
    this.worker.onmessage = ({ data }: MessageEvent<FromLoader>) => {
      this.ready = data.kind === 'started' || data.kind === 'decoded';
      if (data.kind === 'decoded') this.settle!.resolve(data.texels);
      else this.settle?.reject(data);
    };
    void program.then((compiled) => this.tell({ kind: 'help', program: compiled }));
  }

  decode(strip: TexelStrip, bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
    this.ready = false;
    const decoded = new Promise<Uint8Array>((resolve, reject) => { this.settle = { resolve, reject }; });
    this.tell({ kind: 'decode', strip, bytes }, [bytes.buffer]);
    return decoded;
  }

  end(): void { this.worker.terminate(); }

  private tell(message: ToLoader, transfer: Transferable[] = []): void { this.worker.postMessage(message, transfer); }
}

/** Lets the worker hear messages. */
const tick = () => new Promise<null>((resolve) => { setTimeout(() => resolve(null)); });

const endOf = ({ high }: TexelStrip) => high.offset + high.size;

export class EarlyTexels {
  /** The strips that are not decoded; null before begin(). */
  private left: TexelStrip[] | null = null;
  private helper: Helper | null = null;

  /** `engine`: called when texels are decoded. */
  constructor(private readonly engine: () => Engine, private readonly program: Promise<WebAssembly.Module>) {}

  /** Finds the strips. `prefix`: the first bytes of the file with its whole header. */
  begin(prefix: Uint8Array): void {
    if (this.left) return;
    this.left = [];
    try {
      this.engine().setBuffer(prefix.subarray(0, maxHeader));
      this.left = this.engine().call<TexelStrip[]>('begin_texels');
      if (this.left.length > 1) this.helper = new Helper(this.program);
    } catch {}  // the reader reports what is broken
  }

  /** Decodes the next strips, at most two, if they are in `prefix`. */
  async decode(prefix: Uint8Array): Promise<void> {
    const [strip, second] = this.left ?? [];
    const helper = second && this.helper?.ready ? this.helper : null;
    if (!strip || prefix.length < endOf(helper ? second! : strip)) return;
    const left = this.left!.slice(helper ? 2 : 1);
    this.left = [];
    try {
      const other = helper?.decode(second!, new Uint8Array(prefix.subarray(second!.low.offset, endOf(second!))));
      other?.catch(() => {});  // awaited below
      this.engine().setBuffer(prefix.subarray(strip.low.offset, endOf(strip)));
      this.engine().call('decode_texels', strip);
      const texels = await (other ?? tick());
      if (texels) {
        this.engine().setBuffer(texels);
        this.engine().call('add_texels', second);
      }
      this.left = left;
    } catch {}
  }

  /** Whether there are more, after begin(). */
  get isLeft(): boolean { return this.left!.length > 0; }

  end(): void { this.helper?.end(); }
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
