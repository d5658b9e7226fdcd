// Messages between the page and its workers: one loads a scene, another sorts splats.

import type { Parcel } from './engine.js';
import type {
  LoadProgress, DebugViewChoice, SceneFile, SceneSummary, SplatOffer, Vec3, ViewerError,
} from './types.js';

export interface FilesToLoad {
  readonly files: readonly SceneFile[];
  readonly name: string;
  readonly lod?: number;
}

export type SourceToLoad = { readonly url: string; readonly name: string; readonly lod?: number } | FilesToLoad;

/** The loader's description of a scene: web/engine/loader.cpp. */
export interface SceneDescription
  extends Pick<SceneSummary, 'name' | 'source' | 'notes' | 'triangles' | 'splats' | 'appearance' | 'cameras' | 'background'> {
  /** The names of the layers in the file, which may be empty. */
  readonly layer_names: readonly string[];
  readonly subject: { readonly low: Vec3; readonly high: Vec3; readonly up: Vec3 };
  readonly up_reason: string;
  /** The up axis that the file stores, or its reader assumes. */
  readonly file_up: Vec3;
  /** Splats by level of detail, and the level that was read; empty if there are none. */
  readonly levels: readonly number[];
  readonly lod: number;
  /** Whether it was read by the program with all formats. */
  readonly further: boolean;
  readonly debug_views: readonly DebugViewChoice[];
  readonly feature_count: number;
}

export interface PreparedScene {
  readonly description: SceneDescription;
  /** Without the head and the blobs that were sent before. */
  readonly parcel: Parcel;
  /** The reduced lattice level if memory is too small; otherwise null. */
  readonly level: number | null;
  /** Number of strips of texels that were decoded early (early_texels.ts). */
  readonly decoded: number;
  /** Time in the loader: from the file's bytes to the soup, and from there to its plan. */
  readonly readMs: number;
  readonly planMs: number;
}

/** refused: the device's memory is too small for the scene. */
export type Taken = 'uploaded' | 'kept' | 'refused';

/** A part of a store's blob (web/engine/arriving_scene.hpp). */
export interface Block {
  readonly blob: number;
  readonly offset: number;
  readonly size: number;
  /** Its first `size` bytes are the block's. */
  readonly bytes: ArrayBuffer;
}

/** One layer of a source, prepared alone. */
export interface PreparedLayer {
  readonly description: SceneDescription;
  /** Without the head and the blobs that were sent before. */
  readonly parcel: Parcel;
  /** Number of the layer in its source, from 0. */
  readonly index: number;
  /** Forecast of its bytes on the device. */
  readonly forecast: number;
  /** Number of layers that are loaded, and of those that follow. */
  readonly count: number;
  readonly left: number;
}

/** Layers of a source: all or those with these numbers, from 0, with lattices of at most this level. */
export interface WantedLayers {
  readonly indices: readonly number[] | null;
  readonly level: number | null;
}

/** The scene that the page shows, or layers for it, one after the other. */
export type LoadRole = 'scene' | WantedLayers;

export type ToLoader =
  | LoadMessage
  /** Sent when the program is compiled; the download begins before. */
  | { readonly kind: 'program'; readonly program: WebAssembly.Module }
  /** Sent when the device is available; preparing depends on its limits. */
  | { readonly kind: 'limits'; readonly limits: unknown }
  /** The device's memory is too small: prepare the scene with a lower lattice level. */
  | { readonly kind: 'lower'; readonly why: string }
  /** Prepare the next layer: the page holds no more than one at a time. */
  | { readonly kind: 'next' }
  /** The page has taken a block. `bytes`: memory for another block; empty if the page keeps the block. */
  | { readonly kind: 'taken'; readonly taken: Taken; readonly bytes: ArrayBuffer }
  /** The answer to an offer: the number of splats to read. */
  | { readonly kind: 'splats'; readonly number: number }
  | SortMessage
  | WriteMessage
  /** Inflate these streams (inflating.ts). */
  | { readonly kind: 'inflate'; readonly streams: readonly Deflated[] };

/** The pieces of a zlib stream, and its size when it is inflated. */
export interface Deflated {
  readonly pieces: readonly Uint8Array<ArrayBuffer>[];
  readonly size: number;
}

/** The parts of inflated streams, one after the other. */
export type Inflated = readonly Uint8Array<ArrayBuffer>[];

export interface LoadMessage {
  readonly kind: 'load';
  readonly source: SourceToLoad;
  readonly role: LoadRole;
  /** As SplatOffer.memory. */
  readonly memory: number;
  /** Reads at most this number of splats; null: makes an offer if they need more memory. */
  readonly maxSplats: number | null;
  /** Turns the scene upright, so that its up axis becomes this. */
  readonly up: Vec3 | null;
  /** The worker's program: the one with all formats (further); the page's own, which then leaves unknown files to that one
   *  (first); or the page's own, if there is no other (only). */
  readonly program: 'further' | 'first' | 'only';
}

/** Reads sources and writes one file; for a worker with the all-formats program. */
export interface WriteMessage {
  readonly kind: 'write';
  readonly sources: readonly { readonly source: SourceToLoad; readonly memory: number; readonly maxSplats: number | null }[];
  /** The layers, as web/engine/exchange.cpp describes them; null: those of the only source, as they are. */
  readonly document: object | null;
  /** Its extension selects the format. */
  readonly file: string;
}

/** A task for a worker that sorts splats, and does nothing else (splat_sorting.ts). */
export interface SortMessage {
  readonly kind: 'sort';
  readonly program: WebAssembly.Module;
  readonly task: SortTask;
  /** Empty if they are those of the last task. */
  readonly centers: Uint8Array<ArrayBuffer>;
}

/** web/engine/splat_sorting.cpp */
export interface SortTask {
  readonly number: number;
  readonly layers: readonly { readonly axis: Vec3; readonly offset: number; readonly behind: readonly boolean[] }[];
}

export type FromLoader =
  | { readonly kind: 'progress'; readonly progress: LoadProgress }
  | { readonly kind: 'preview'; readonly scene: PreparedScene }
  /** The loader waits for the answer, 'splats'. */
  | { readonly kind: 'offer'; readonly offer: SplatOffer }
  /** The head of a large scene or layer, whose blocks and 'scene' or 'layer' follow. */
  | { readonly kind: 'head'; readonly head: ArrayBuffer }
  | { readonly kind: 'block'; readonly block: Block }
  | { readonly kind: 'scene'; readonly scene: PreparedScene }
  | { readonly kind: 'layer'; readonly layer: PreparedLayer }
  /** The program does not recognise the scene. The all-formats program may read it. `downloaded`: the file of a source by
   *  address. */
  | { readonly kind: 'elsewhere'; readonly downloaded: Blob | null }
  | { readonly kind: 'written'; readonly bytes: Uint8Array<ArrayBuffer>; readonly losses: readonly string[] }
  | { readonly kind: 'inflated'; readonly inflated: Inflated }
  | { readonly kind: 'sorted'; readonly number: number; readonly order: Uint8Array<ArrayBuffer> }
  | { readonly kind: 'error'; readonly error: { readonly kind: ViewerError['kind']; readonly message: string } };
