// Reads a preview from the first bytes of a GLB: an image of mean colours, which precede the texels in
// the file (docs/format.md).

import type { Engine } from './engine.js';
import type { SceneDescription } from './loader_messages.js';

export class Preview {
  /** Number of bytes for a preview; null while unknown. */
  private needed: number | null = null;
  /** Number of bytes at the last query of `needed`; the next query follows at twice this number. */
  private asked = 0;
  private over = false;

  constructor(private readonly engine: Engine, private readonly name: string) {}

  /** A description when there are enough bytes, only once. Ignores a broken file: its reader reports the
   *  error later. */
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
