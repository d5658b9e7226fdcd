// Decodes a soup's texels while their file arrives (formats/tureen_glb/early_texels.hpp). A second worker inflates them, because
// the loader must receive the file; when the file is there, both do.

import type { Engine } from './engine.js';
import { canInflate, inflate, SecondInflater } from './inflating.js';
import type { Deflated, Inflated } from './loader_messages.js';
import { pause } from './pause.js';
import { maxHeader } from './preview.js';

/** Bytes of a file, or of a strip. */
interface Range {
  readonly offset: number;
  readonly size: number;
}

/** web/engine/loader.cpp */
interface DeflatedImages {
  readonly width: number;
  readonly inflated: number;
  readonly images: readonly (readonly Range[])[];
}

interface StartedStrip {
  readonly width: number;
  readonly inflated: Promise<Inflated>;
}

export class EarlyTexels {
  /** Number of decoded strips, the first ones of the file. */
  decoded = 0;
  private strips: readonly Range[] | null = null;  // null before begin()
  /** Strips after the decoded ones. */
  private readonly started: StartedStrip[] = [];
  private second: SecondInflater | null = null;
  /** The bytes so far. */
  private prefix: Uint8Array<ArrayBuffer> = new Uint8Array();
  private isWhole = false;
  private work: Promise<void> | null = null;
  private onStrip: (fraction: number) => void = () => {};

  /** `engine`: called when texels are decoded. */
  constructor(private readonly engine: () => Engine) {}

  /** Finds the strips once `prefix`, the first bytes of the file, has its whole header. `known`: it has. */
  begin(prefix: Uint8Array<ArrayBuffer>, known: boolean): void {
    if (this.strips || !(known || prefix.length >= maxHeader)) return;
    this.strips = [];
    if (!canInflate()) return;
    try {
      this.engine().setBuffer(prefix.subarray(0, maxHeader));
      this.strips = this.engine().call<Range[]>('begin_texels');
      if (this.strips.length > 1) this.second = new SecondInflater();
    } catch {}  // the reader reports what is broken; some browsers allow no worker in a worker
  }

  /** Decodes the strips that are in `prefix`, and does not wait for them. */
  feed(prefix: Uint8Array<ArrayBuffer>): void {
    this.prefix = prefix;
    this.work ??= this.decodeStrips().catch(() => this.giveUp()).finally(() => { this.work = null; });
  }

  /** Decodes all that is left. `bytes`: the whole file. `each`: called after each strip with the fraction done. */
  async finish(bytes: Uint8Array<ArrayBuffer>, each: (fraction: number) => void): Promise<void> {
    this.begin(bytes, true);
    this.onStrip = each;
    this.isWhole = true;
    await this.work;
    this.feed(bytes);
    await this.work;
    this.second?.end();
    this.prefix = new Uint8Array();
  }

  /** The reader decodes the strips that are left. */
  private giveUp(): void {
    this.strips = [];
    this.started.length = 0;
  }

  private async decodeStrips(): Promise<void> {
    const { second } = this;
    for (;;) {
      while (second?.isFree && this.start((streams) => second.inflate(streams)));
      if (this.isWhole || !second) this.start(inflate);
      const next = this.started.shift();
      if (!next) return;
      const streams = await next.inflated;
      this.engine().setBuffer(...streams);
      if (!this.engine().call<boolean>('add_texels', { width: next.width })) throw new RangeError('damaged');
      this.onStrip(++this.decoded / this.strips!.length);
      await pause();
    }
  }

  /** Starts the next strip; returns whether the bytes contain it. Throws if it is damaged. */
  private start(how: (streams: readonly Deflated[]) => Promise<Inflated>): boolean {
    const index = this.decoded + this.started.length, strip = this.strips?.[index];
    if (!strip || strip.offset + strip.size > this.prefix.length) return false;
    const bytes = this.prefix.subarray(strip.offset, strip.offset + strip.size);
    this.engine().setBuffer(bytes);
    const deflated = this.engine().call<DeflatedImages | null>('deflated_images', index);
    if (!deflated) throw new RangeError('damaged');
    const streams = deflated.images.map((pieces) => ({
      pieces: pieces.map(({ offset, size }) => bytes.subarray(offset, offset + size)), size: deflated.inflated }));
    const inflated = how(streams);
    inflated.catch(() => {});  // until it is awaited
    this.started.push({ width: deflated.width, inflated });
    return true;
  }
}
