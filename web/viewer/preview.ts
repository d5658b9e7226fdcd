// Whether what has arrived of a GLB is enough for a picture of mean colours, which lie before the
// texels (docs/format.md).

import type { Engine } from './engine.js';
import type { SceneDescription } from './loader_messages.js';

const glb = 0x46546c67;  // "glTF"

export class Preview {
  private needed: number | null = null;
  private over = false;

  constructor(private readonly engine: Engine, private readonly name: string) {}

  /** A description once there is enough, and never twice. A file that is broken is left to its reader,
   *  which says what is wrong with it. */
  read(prefix: Uint8Array): SceneDescription | null {
    if (this.over || prefix.length < 20) return null;
    try {
      return this.tryToRead(prefix);
    } catch {
      this.over = true;
      return null;
    }
  }

  private tryToRead(prefix: Uint8Array): SceneDescription | null {
    const head = new DataView(prefix.buffer, prefix.byteOffset, prefix.length);
    if (head.getUint32(0, true) !== glb) this.over = true;
    const jsonEnd = 28 + head.getUint32(12, true);  // and the header of the chunk behind it
    if (this.over || prefix.length < jsonEnd) return null;
    if (this.needed === null) {
      this.engine.setBuffer(prefix.subarray(0, jsonEnd));
      this.needed = this.engine.call<number | null>('preview_size', { name: this.name }) ?? 0;
      this.over = this.needed === 0;
    }
    if (this.over || prefix.length < this.needed) return null;
    this.over = true;
    this.engine.setBuffer(prefix.subarray(0, this.needed));
    return this.engine.call<SceneDescription | null>('preview', { name: this.name });
  }
}
