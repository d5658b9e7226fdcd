// Sends a prepared scene from the loader to the page: large scenes in blocks, which the page uploads while the next ones
// are filled (arriving_scene.ts).

import type { Engine, Parcel } from './engine.js';
import type { FromLoader, Taken } from './loader_messages.js';

/** Maximum size of a block, and of a blob's part in the engine's memory. */
const blockBytes = 1 << 20;
/** A scene with a store of this size is large: its stores are sent in blocks. */
const largeStore = 4 * blockBytes;
/** Maximum number of blocks on their way. */
const maxBlocks = 4;

/** web/engine/loader.cpp */
export interface BlobSize {
  readonly size: number;
  readonly grain: number;
  /** It goes to the device, and can be uploaded before the rest is there. */
  readonly is_store: boolean;
}

/** What the engine has prepared; the blobs are still in its memory. */
export interface Prepared {
  readonly head: ArrayBuffer;
  readonly blobs: readonly BlobSize[];
}

/** A multiple of the grain. */
const blockSize = (grain: number) => Math.max(Math.floor(blockBytes / grain), 1) * grain;

export class Sending {
  private readonly spares: ArrayBuffer[] = [];
  private onTheirWay = 0;  // blocks
  private refused = false;  // a block of this scene
  private onTaken: () => void = () => {};

  constructor(private readonly engine: () => Engine, private readonly post: (message: FromLoader) => void) {}

  /** The whole scene. */
  parcel({ head, blobs }: Prepared): Parcel {
    return { head, blobs: blobs.map((blob, index) => this.blob(index, blob)) };
  }

  /** The same, but without what it has sent in blocks before, because the scene is large. */
  async send({ head, blobs }: Prepared): Promise<Parcel> {
    if (!blobs.some(({ size, is_store }) => is_store && size >= largeStore)) return this.parcel({ head, blobs });
    this.refused = false;
    this.post({ kind: 'head', head });
    const others: ArrayBuffer[] = [];
    for (const [index, blob] of blobs.entries()) {
      others.push(blob.is_store ? new ArrayBuffer() : this.blob(index, blob));
      if (blob.is_store) await this.sendBlocks(index, blob);
    }
    return { head: new ArrayBuffer(), blobs: others };
  }

  /** The page's answer to a block. */
  taken(taken: Taken, bytes: ArrayBuffer): void {
    --this.onTheirWay;
    if (taken === 'refused') this.refused = true;
    this.spares.push(bytes);
    this.onTaken();
  }

  private blob(index: number, { size, grain }: BlobSize): ArrayBuffer {
    const bytes = new Uint8Array(size), step = blockSize(grain);
    for (let offset = 0; offset < size; offset += step)
      bytes.set(this.block(index, offset, Math.min(step, size - offset)), offset);
    return bytes.buffer;
  }

  private async sendBlocks(blob: number, { size, grain }: BlobSize): Promise<void> {
    const step = blockSize(grain);
    for (let offset = 0; offset < size && !this.refused; offset += step) {
      const part = Math.min(step, size - offset), bytes = await this.spareBlock(part);
      new Uint8Array(bytes).set(this.block(blob, offset, part));
      this.post({ kind: 'block', block: { blob, offset, size: part, bytes } });
    }
  }

  /** A view of the engine's memory, which grows meanwhile; valid until the next command. */
  private block(blob: number, offset: number, size: number): Uint8Array {
    this.engine().call('read_block', { blob, offset, size });
    return this.engine().buffer();
  }

  /** Memory for a block, once the page has taken earlier ones: allocating a block takes longer than filling it. */
  private async spareBlock(size: number): Promise<ArrayBuffer> {
    while (this.onTheirWay === maxBlocks) await new Promise<void>((resolve) => { this.onTaken = resolve; });
    ++this.onTheirWay;
    const spare = this.spares.pop();
    return spare && spare.byteLength >= size ? spare : new ArrayBuffer(size);
  }
}
