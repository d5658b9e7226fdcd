// Reads previews from the first bytes of a file (formats/scene_preview.hpp): a soup in mean colours, splats in the
// colours of degree 0, or the first splats.

import type { Engine } from './engine.js';
import type { SceneDescription } from './loader_messages.js';

/** Splats are shown early only after this time: below, the whole scene follows so soon that a preview delays it. */
const patienceMs = 300;

/** Largest part of a file for a preview of splats, in bytes, and as a fraction of the memory for a scene: the part and
 *  its splats are in the loader's memory at once. */
const maxSplatBytes = 256 << 20, maxSplatPart = 1 / 16;
/** The headers of files with several previews, or with strips of texels, are not larger. */
export const maxHeader = 1 << 20;
/** A GLB whose JSON does not fit has no preview. */
const maxJson = 8 << 20;

/** web/engine/loader.cpp */
interface PreviewSize {
  readonly size: number;
  readonly has_splats: boolean;
}

export class Preview {
  /** The next preview; null while unknown. */
  private next: PreviewSize | null = null;
  /** Number of bytes of the last preview. */
  private shown = 0;
  /** Number of bytes at the last query of `next`; the next query follows at twice this number. */
  private asked = 0;
  /** The next preview of splats is not made before this time. */
  private notBefore: number;
  private over = false;

  /** `engine`: called for a preview. `memory`: as SplatOffer.memory. `begun`: when the download began, by
   *  performance.now(). */
  constructor(private readonly engine: () => Engine, private readonly name: string, private readonly memory: number,
              begun: number) {
    this.notBefore = begun + patienceMs;
  }

  /** Ends the previews. */
  stop(): void { this.over = true; }

  /** Whether the bytes contained the file's whole header. */
  get knowsHeader(): boolean { return this.next !== null || this.shown > 0 || this.over; }

  /** Time that a preview took in all. At most a third of the time is spent on previews. */
  took(ms: number): void { this.notBefore = performance.now() + 2 * ms; }

  /** A description whenever there are enough bytes for a further preview; `total`: the size of the file, if it is
   *  known. Ignores a broken file: its reader reports the error later. */
  read(prefix: Uint8Array, total: number | null): SceneDescription | null {
    if (this.over) return null;
    try {
      return this.tryToRead(prefix, total);
    } catch {
      this.over = true;
      return null;
    }
  }

  private tryToRead(prefix: Uint8Array, total: number | null): SceneDescription | null {
    if (this.next === null && prefix.length >= 2 * this.asked) {
      this.asked = prefix.length;
      this.engine().setBuffer(prefix.subarray(0, this.shown === 0 ? maxJson : maxHeader));
      this.next = this.engine().call<PreviewSize | null>('preview_size', { name: this.name, shown: this.shown });
    }
    const { next } = this;
    if (next === null) return null;
    const size = Math.max(next.size, next.has_splats ? prefix.length : 0);
    // The whole scene follows soon after three quarters of the file.
    this.over = next.size === 0 || (next.has_splats && size > Math.min(maxSplatBytes, maxSplatPart * this.memory, 0.75 * (total ?? Infinity)));
    if (this.over || prefix.length < next.size || (next.has_splats && performance.now() < this.notBefore)) return null;
    this.engine().setBuffer(prefix.subarray(0, size));
    const description = this.engine().call<SceneDescription | null>('preview', { name: this.name });
    this.shown = size;
    this.next = null;
    this.asked = 0;
    return description;
  }
}
