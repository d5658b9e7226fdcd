// Whether what has arrived of a GLB is enough for an image of mean colours, which lie before the
// texels (docs/format.md).

import type { Engine } from './engine.js';
import type { SceneDescription } from './loader_messages.js';

export class Preview {
  /** Bytes that a preview takes; null until that can be told. */
  private needed: number | null = null;
  /** So many had come when the engine was asked last: it is asked again when twice as many have. */
  private asked = 0;
  private over = false;

  constructor(private readonly engine: Engine, private readonly name: string) {}

  /** A description once there is enough, and never twice. A file that is broken is left to its reader,
   *  which says what is wrong with it. */
  read(prefix: Uint8Array): SceneDescription | null {
    if (this.over) return null;
    try {
      return this.tryToRead(prefix);
    } catch {
      this.over = true;
      return null;
    }
  }

  private tryToRead(prefix: Uint8Array): SceneDescription | null {
    if (this.needed === null && prefix.length >= 2 * this.asked) {
      this.asked = prefix.length;
      this.engine.setBuffer(prefix);
      this.needed = this.engine.call<number | null>('preview_size', { name: this.name });
      this.over = this.needed === 0;
    }
    if (this.over || this.needed === null || prefix.length < this.needed) return null;
    this.over = true;
    this.engine.setBuffer(prefix.subarray(0, this.needed));
    return this.engine.call<SceneDescription | null>('preview', { name: this.name });
  }
}
