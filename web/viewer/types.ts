// What a viewer can be asked, and what it tells. `createViewer` (viewer.ts) makes one of a canvas;
// the page, the embedding API and the package's type declarations are all of this file.
//
// Lengths on the screen are CSS pixels from the canvas's top left corner; angles are radians;
// colours are display-referred, 0..1; world coordinates are the scene's own.

import type { Assets } from './assets.js';

export type Vec3 = readonly [number, number, number];

/** One file of a scene; `path` is relative to the scene's folder: "mesh.ply", "textures/a.png". */
export interface SceneFile {
  readonly path: string;
  readonly data: Blob;
}

/** A file by its address, or files at hand: one, or all of a folder. */
export type SceneSource =
  | { readonly url: string; readonly name?: string }
  | { readonly files: readonly SceneFile[]; readonly name?: string };

/** A camera that the scene's file brings. */
export interface SceneCamera {
  readonly name: string;
  readonly width: number;
  readonly height: number;
}

/** What is known of the scene that is shown. */
export interface SceneSummary {
  readonly name: string;
  /** The method or format that it came from, for people; may be empty. */
  readonly source: string;
  /** What reading it assumed or lost: a sentence each. */
  readonly notes: readonly string[];
  readonly triangles: number;
  /** "lattice texture", "face colours", .. */
  readonly appearance: string;
  /** How it is drawn and what is left out, a sentence each. */
  readonly plan: readonly string[];
  readonly cameras: readonly SceneCamera[];
  readonly background: Vec3;
  readonly up: Vec3;
  /** Why this axis is up: a sentence. */
  readonly upReason: string;
  readonly lookChoices: readonly LookChoice[];
  /** What the look "features" can choose among; 0 where it has none. */
  readonly featureCount: number;
  /** Bytes of its buffers and textures on the device. */
  readonly deviceBytes: number;
}

/** Something that a frame can show instead of the final colours. */
export interface LookChoice {
  /** "color", "depth", "normals", "triangle-id", .. */
  readonly look: string;
  readonly title: string;
  /** In a few words. */
  readonly meaning: string;
  /** Why this scene has it not, in a sentence; null where it has. */
  readonly missing: string | null;
}

/** What the colours of a look mean. */
export interface LegendEntry {
  readonly color: Vec3;
  readonly text: string;
}

export type LoadStage = 'download' | 'read' | 'prepare' | 'upload';

export interface LoadProgress {
  readonly stage: LoadStage;
  /** 0..1 over all stages together; null while it cannot be known. */
  readonly fraction: number | null;
  readonly loadedBytes: number;
  /** null where the server does not say. */
  readonly totalBytes: number | null;
}

export type NavigationMode = 'orbit' | 'fly';

export const namedViews = [
  'front', 'back', 'left', 'right', 'top', 'bottom',
  'three-quarter', 'three-quarter-left', 'three-quarter-back',
] as const;
export type NamedView = (typeof namedViews)[number];

/** A camera by its numbers, at any size: what links carry and what is saved. A recorded camera's
 *  principal point is not among them. */
export interface ViewPose {
  readonly eye: Vec3;
  readonly target: Vec3;
  readonly up: Vec3;
  /** The full vertical angle. */
  readonly fov: number;
  /** Of the camera's head to its left; 0 but for recorded cameras. */
  readonly roll: number;
}

/** Resolution of the image: a factor of the screen's own pixels, 0.25..1 and 2 for four samples a
 *  pixel (what lies beyond is brought within), or the factor that holds a frame rate above 0. */
export type Resolution = number | { readonly targetFps: number };

export interface FrameStats {
  /** Between frames, median of the last second; null at rest, when nothing is drawn. */
  readonly frameMs: number | null;
  readonly p95Ms: number | null;
  /** Of the processor, to submit a frame. */
  readonly submitMs: number | null;
  readonly width: number;
  readonly height: number;
  /** The factor that Resolution has led to. */
  readonly scale: number;
  /** Of WebAssembly, now. */
  readonly wasmBytes: number;
  /** GL_RENDERER as far as the browser tells. */
  readonly renderer: string;
}

export interface ViewerEvents {
  /** A load goes on. */
  progress: LoadProgress;
  /** A first image, of mean colours, while the rest is on its way. */
  preview: { readonly triangles: number };
  /** A scene is shown, or none is. */
  scene: SceneSummary | null;
  /** Something that a person should read: what was left out, a lower level for want of memory. */
  notice: string;
  /** A frame was drawn. Use it sparingly. */
  frame: FrameStats;
  /** The view has come to rest after it was asked to move. */
  view: ViewPose;
  /** The GL context was lost, or is back and the scene with it. */
  context: 'lost' | 'restored';
}

/** input: a file is broken or of no kind that is read; the sentence says where. network: an address cannot
 *  be had. memory: the device or the page has not enough. device: it fails otherwise. no-webgl2: there is
 *  none. cancelled: by the caller or a later load. usage: something was asked for that there is not. */
export type ErrorKind = 'input' | 'network' | 'memory' | 'device' | 'no-webgl2' | 'cancelled' | 'usage';

/** What went wrong, in a sentence that may be shown. */
export class ViewerError extends Error {
  constructor(message: string, readonly kind: ErrorKind) {
    super(message);
    this.name = 'ViewerError';
  }
}

export interface Viewer {
  readonly canvas: HTMLCanvasElement;
  readonly scene: SceneSummary | null;
  readonly stats: FrameStats;

  /** Replaces the scene once the new one is whole (its preview comes before). A load that is under
   *  way is cancelled by the next one and by the signal: its promise is rejected with 'cancelled'
   *  and the scene before stays. It makes way once the new one has arrived: where the device then cannot
   *  take that, there is none. Rejects with ViewerError. */
  load(source: SceneSource, options?: { readonly signal?: AbortSignal }): Promise<SceneSummary>;
  /** Shows nothing. */
  clear(): void;

  on<E extends keyof ViewerEvents>(event: E, listener: (what: ViewerEvents[E]) => void): () => void;

  // Looking around. Deltas as a pointer has them.
  mode: NavigationMode;
  orbit(dx: number, dy: number): void;
  pan(dx: number, dy: number): void;
  look(dx: number, dy: number): void;
  /** Each step takes a tenth of the distance; towards the pointer where one is given. */
  dolly(steps: number, pointer?: readonly [number, number]): void;
  /** The speed of flying, each step 1.2 times. */
  scaleSpeed(steps: number): void;
  /** World units a second, of fly with factor 1. */
  readonly speed: number;
  /** Whether views glide to where they are asked to be; false for who asks for reduced motion. */
  gliding: boolean;
  /** Flies on until it is told otherwise: in the camera's axes (x right, y up, -z forward). */
  fly(direction: Vec3, factor: number): void;
  /** Brings the point under the pointer to the centre. False where there is only background. */
  focus(x: number, y: number): boolean;
  /** The whole scene from where the eye is. */
  frame(): void;
  /** The first view. */
  home(): void;
  showNamedView(view: NamedView): void;
  /** Index into SceneSummary.cameras. Throws ViewerError where there is none of this number. */
  showCamera(index: number): void;
  setUp(axis: Vec3): void;
  getView(): ViewPose;
  /** `glide`: not at once. Throws ViewerError where eye and target are the same point. */
  setView(pose: ViewPose, options?: { readonly glide?: boolean }): void;
  /** The full vertical angle: above 0 and below pi. */
  fov: number;

  // Drawing.
  background: Vec3;
  resolution: Resolution;
  /** "color" is the scene as it is drawn. Other looks read the scene again, so it may take a
   *  moment; a later call wins. `features`: what "features" shows as red, green and blue, `count` 1 to 3
   *  from `first` below SceneSummary.featureCount. Rejects with ViewerError where the scene has it not. */
  show(look: string, features?: { readonly first: number; readonly count: number }): Promise<void>;
  readonly shownLook: string;
  readonly legend: readonly LegendEntry[];
  /** A PNG of what is shown, of the given size or the canvas's: at most as large as the device's
   *  largest image. Rejects with ViewerError. */
  screenshot(size?: { readonly width: number; readonly height: number }): Promise<Blob>;
  /** Draws again, at once. */
  draw(): void;

  dispose(): void;
}

export interface ViewerOptions {
  /** Where tureen.wasm and the loader's worker lie; beside the script where it is not given. Or how
   *  to get them. */
  readonly assets?: string | Assets;
  /** What `load` will be asked for first: it arrives while the viewer starts, and so is shown sooner. */
  readonly expected?: SceneSource;
  /** Whether pointers, wheel and keys on the canvas move the view; true. */
  readonly controls?: boolean;
  readonly background?: Vec3;
  readonly resolution?: Resolution;
}
