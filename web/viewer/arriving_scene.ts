// A large scene, which the page uploads block by block while the loader still prepares it.

import type { Engine } from './engine.js';
import type { Block, Taken } from './loader_messages.js';

export class ArrivingScene {
  private failure: unknown = null;

  /** `kept`: keeps the blocks until finish(), because the device still holds another scene. */
  constructor(private readonly engine: Engine, head: ArrayBuffer, private readonly kept: Block[] | null) {
    engine.takeHead(head);
  }

  /** Returns what has happened to the block. Errors are thrown by finish(). */
  take(block: Block): Taken {
    if (this.kept) {
      this.kept.push(block);
      return 'kept';
    }
    this.upload(block);
    return this.failure === null ? 'uploaded' : 'refused';
  }

  /** After all blocks; the device holds no other scene. Then the engine can show the scene. Throws ViewerError. */
  finish(): void {
    for (let block; (block = this.kept?.shift());) this.upload(block);  // each is freed after its upload
    if (this.failure !== null) throw this.failure;
  }

  /** Frees its memory in the engine and on the device. */
  drop(): void { this.engine.call('forget_head'); }

  private upload({ blob, offset, size, bytes }: Block): void {
    if (this.failure !== null) return;
    try {
      this.engine.setBuffer(new Uint8Array(bytes, 0, size));
      this.engine.call('upload_block', { blob, offset });
    } catch (error) {
      this.failure = error;
      this.drop();
    }
  }
}
