// The interface of a viewer. `createViewer` (viewer.ts) creates one on a canvas. The page, the embedding
// API and the package's type declarations use this file.
//
// Lengths on the screen are CSS pixels from the canvas's top left corner; angles are radians; colours
// are display-referred, 0..1; world coordinates are the scene's.

/** The files that the viewer needs besides its script (assets.ts). */
export interface Assets {
  /** The bytes of tureen.wasm. */
  wasm(): Promise<ArrayBuffer>;
  /** A new worker that runs the loader. Rejects with ViewerError if its script cannot be fetched. */
  loaderWorker(): Promise<Worker>;
  /** The same for the program that reads all formats and writes files, when it is needed. Without it, the viewer reads the
   *  formats of the first program, and writes nothing. */
  readonly further?: Pick<Assets, 'wasm' | 'loaderWorker'>;
  /** The page as one file, into which a scene is written. */
  template?(): Promise<string>;
}

export type Vec3 = readonly [number, number, number];

/** One file of a scene; `path` is relative to the scene's folder: "mesh.ply", "textures/a.png". */
export interface SceneFile {
  readonly path: string;
  readonly data: Blob;
}

/** A file by its address, or local files: one, or all of a folder. A SOG in several files is the address of its meta.json
 *  or lod-meta.json. `lod`: the level of detail of a streamed scene, 0 is the finest; by default the finest that fits
 *  the memory. */
export type SceneSource =
  | { readonly url: string; readonly name?: string; readonly lod?: number }
  | { readonly files: readonly SceneFile[]; readonly name?: string; readonly lod?: number };

/** What `write` writes. html: the page with the scene, as one file that opens from the disk. */
export const writtenFormats = ['glb', 'ply', 'html'] as const;
export type WrittenFormat = (typeof writtenFormats)[number];

/** A file that was written, and a sentence for each thing that the format cannot hold. */
export interface WrittenScene {
  readonly file: Blob;
  readonly losses: readonly string[];
}

/** What `play` plays: a turn about what the recorded cameras look at, or about the target of the view without them; or a
 *  flight along the recorded cameras. */
export type Tour = 'turntable' | 'cameras';

/** A recorded camera from the scene's file. */
export interface SceneCamera {
  readonly name: string;
  readonly width: number;
  readonly height: number;
}

/** Facts about the current scene. */
export interface SceneSummary {
  readonly name: string;
  /** The method or format of its origin, as text; may be empty. */
  readonly source: string;
  /** Assumptions and losses of the reader, one sentence each. */
  readonly notes: readonly string[];
  readonly triangles: number;
  readonly splats: number;
  /** "lattice texture", "face colours", "Gaussians (profile 3dgs)", .. */
  readonly appearance: string;
  /** The drawing plan and its specialisations, one sentence each. */
  readonly plan: readonly string[];
  readonly cameras: readonly SceneCamera[];
  readonly background: Vec3;
  readonly up: Vec3;
  /** The reason for the choice of the up axis: a sentence. */
  readonly upReason: string;
  readonly debugViews: readonly DebugViewChoice[];
  /** Number of features for the debug view "features"; 0 without features. */
  readonly featureCount: number;
  /** Size of its buffers and textures on the device, in bytes. */
  readonly deviceBytes: number;
  /** Whether nothing is drawn but splats, in tiles, by the processor: they take no memory of the device. */
  readonly splatsByProcessor: boolean;
  /** Of a streamed scene without layers from elsewhere: its splats by level of detail, the finest first, and the shown level. */
  readonly detail: { readonly splats: readonly number[]; readonly level: number } | null;
}

/** 16 numbers, column by column, as in glTF: a similarity (rotation, translation, one scale, optionally a
 *  mirror). */
export type Matrix = readonly number[];

/** The parts of a layer's transform, applied in the order mirror, scale, rotation, position. */
export interface Placement {
  readonly position: Vec3;
  /** Angles about the world's axes: first about x, then about y, then about z. */
  readonly rotation: Vec3;
  /** Above 0. */
  readonly scale: number;
  /** Whether x is negated. */
  readonly mirror: boolean;
}

/** A set of triangles or splats of the current scene. At equal depth the earlier layer is visible. */
export interface SceneLayer {
  /** No other layer of the viewer has it; a removed layer that returns keeps it. */
  readonly id: number;
  /** Unique among the layers: "fox", "fox 2". */
  readonly name: string;
  readonly triangles: number;
  readonly splats: number;
  readonly visible: boolean;
  /** From the layer's coordinates to the world's. */
  readonly transform: Matrix;
  readonly placement: Placement;
  /** Size of its buffers and textures on the device, in bytes. */
  readonly deviceBytes: number;
  /** The argument of `load` or `addLayers`, and the layer's number in it, from 0. */
  readonly source: SceneSource;
  readonly sourceLayer: number;
}

/** The box around all layers, in world units with four digits. Splats that are far from all others do not count. */
export interface SceneBox {
  /** Along x, y and z: "2.1 × 3 × 0.75". */
  readonly extent: string;
  /** Lowest and highest corner: "-1, 0, 2.5". */
  readonly low: string;
  readonly high: string;
}

/** What the user can undo: the steps since the scene was opened. */
export interface Steps {
  /** "Move fox", "Change the up axis", ..; the oldest first. */
  readonly names: readonly string[];
  /** Number of steps that are done; the others are undone. */
  readonly position: number;
}

/** Largest number of layers of a scene: the device stores a layer's number in 8 bits. */
export const maxLayers = 255;

/** A debug view, or the final colours. */
export interface DebugViewChoice {
  /** "color", "depth", "normals", "triangle-id", .. */
  readonly name: string;
  readonly title: string;
  /** A short description. */
  readonly meaning: string;
  /** The reason why this scene does not support it, as a sentence; null if it does. */
  readonly missing: string | null;
}

/** The meaning of a colour in a debug view. */
export interface LegendEntry {
  readonly color: Vec3;
  readonly text: string;
}

/** write: of a file for the user. */
export type LoadStage = 'download' | 'read' | 'prepare' | 'upload' | 'write';

export interface LoadProgress {
  readonly stage: LoadStage;
  /** 0..1 over all stages together; null while unknown. */
  readonly fraction: number | null;
  readonly loadedBytes: number;
  /** null if the server does not report it. */
  readonly totalBytes: number | null;
  /** Forecast of the bytes on the device for the added layers that are not uploaded yet; otherwise null. */
  readonly deviceBytes: number | null;
}

export type NavigationMode = 'orbit' | 'fly';

export const namedViews = [
  'front', 'back', 'left', 'right', 'top', 'bottom',
  'three-quarter', 'three-quarter-left', 'three-quarter-back',
] as const;
export type NamedView = (typeof namedViews)[number];

/** A camera for any image size, for links and saved views. It does not contain the principal point of a
 *  recorded camera. */
export interface ViewPose {
  readonly eye: Vec3;
  readonly target: Vec3;
  readonly up: Vec3;
  /** The full vertical angle. */
  readonly fov: number;
  /** Tilt of the camera to its left; 0 except for recorded cameras. */
  readonly roll: number;
}

/** Resolution of the image: a factor on the screen's pixels, clamped to 0.25..2 (2 gives four samples per
 *  pixel), or a frame rate above 0 that an automatic factor maintains. */
export type Resolution = number | { readonly targetFps: number };

/** How splats are blended: by the device (raster), on the processor in tiles, which is faster where the device is
 *  software, or by the faster of the two for the device (auto). Both have the same image. */
export const splatBlendings = ['auto', 'raster', 'tiles'] as const;
export type SplatBlending = (typeof splatBlendings)[number];

/** A scene with more splats than the memory probably holds. */
export interface SplatOffer {
  /** The name of its file. */
  readonly name: string;
  readonly splats: number;
  /** Forecast of the bytes that all splats need, in the page and on the device together. */
  readonly bytes: number;
  /** The memory, in bytes, and the number of splats that fit it. */
  readonly memory: number;
  readonly fitting: number;
}

export interface FrameStats {
  /** Interval between frames, median over the last second; null while no frames are drawn. */
  readonly frameMs: number | null;
  readonly p95Ms: number | null;
  /** Processor time to submit a frame. */
  readonly submitMs: number | null;
  readonly width: number;
  readonly height: number;
  /** The current factor of Resolution. */
  readonly scale: number;
  /** Current memory of WebAssembly. */
  readonly wasmBytes: number;
  /** GL_RENDERER, as far as the browser reports it. */
  readonly renderer: string;
}

export interface ViewerEvents {
  /** Progress of a load. */
  progress: LoadProgress;
  /** A first image with mean colours or a part of the splats is shown, while the load continues. A load may have
   *  several. */
  preview: { readonly triangles: number; readonly splats: number };
  /** The current scene changed, or layers were added or removed; null for none. */
  scene: SceneSummary | null;
  /** The list of layers, or a member of it, changed. */
  layers: readonly SceneLayer[];
  /** Steps were made, undone, redone or forgotten. */
  steps: Steps;
  /** A message for the user, for example about a lower lattice level because of too little memory. */
  notice: string;
  /** A frame was drawn. Use it sparingly. */
  frame: FrameStats;
  /** The view stopped moving. */
  view: ViewPose;
  /** A tour began or ended. */
  tour: Tour | null;
  /** The GL context was lost, or it and the scene were restored. */
  context: 'lost' | 'restored';
}

/** input: a file is broken or has an unsupported format; the message has the position. network: an address
 *  cannot be loaded. memory: the device or the page has too little memory. device: another failure of the
 *  device. no-webgl2: the browser has no WebGL2. cancelled: by the caller or a later load. usage: an invalid
 *  argument or call. */
export type ErrorKind = 'input' | 'network' | 'memory' | 'device' | 'no-webgl2' | 'cancelled' | 'usage';

/** An error with a message for the user. */
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

  /** Replaces the scene when the new one is complete; a preview may come earlier. The next load and the
   *  signal cancel a running load: its promise rejects with 'cancelled', and the old scene stays. A
   *  complete new scene replaces the old one before its upload. If the upload fails, no scene is left. The
   *  viewer draws the layers that fit the device's memory; notices name the others.
   *  Rejects with ViewerError. */
  load(source: SceneSource, options?: { readonly signal?: AbortSignal }): Promise<SceneSummary>;
  /** Removes the scene. */
  clear(): void;

  // Layers. A loaded scene has at least one. Background, up axis and cameras stay those of the loaded scene.

  readonly layers: readonly SceneLayer[];
  /** Null without a scene. */
  readonly box: SceneBox | null;
  /** Adds the layers of another source after the present ones, together, and resolves to them; the view stays. Without
   *  a scene it loads the source. Several calls run one after the other; `load`, `clear` and the signal
   *  cancel them. A layer that the device's memory cannot hold is not added: a notice names it and its
   *  bytes, and the others are drawn. Rejects with ViewerError, also if no layer was added, or if there would
   *  be more than `maxLayers`; then no layer of the source is left. */
  addLayers(source: SceneSource, options?: { readonly signal?: AbortSignal }): Promise<readonly SceneLayer[]>;
  /** Changes the members that are given. Throws ViewerError if the transform is not a similarity. */
  setLayer(index: number, change: { readonly visible?: boolean; readonly transform?: Matrix | Placement }): void;
  /** Frees the layer's memory. Without its only layer, there is no scene. Resolves when it is removed. */
  removeLayer(index: number): Promise<void>;
  /** Moves a layer to another place in the list. */
  moveLayer(from: number, to: number): Promise<void>;

  // Steps. Each call above that changes layers, setUp(), and a change of `background` is a step. A moved view is none. A
  // loaded scene begins without steps. Removed layers are read again from their sources when they return.

  readonly steps: Steps;
  /** While it is true, changes of the same thing are one step: set it while the user drags. */
  holding: boolean;
  /** Undoes the last step, if there is one, after earlier loads and additions. `load`, `clear`, the signal, and a step that
   *  is made while sources are read cancel it; then nothing has changed. Rejects with ViewerError, also if a source cannot be read again. */
  undo(options?: { readonly signal?: AbortSignal }): Promise<void>;
  /** Repeats the next undone step; otherwise as undo(). */
  redo(options?: { readonly signal?: AbortSignal }): Promise<void>;
  /** Undoes or repeats steps until Steps.position is this; otherwise as undo(). */
  goToStep(position: number, options?: { readonly signal?: AbortSignal }): Promise<void>;
  /** The present state can no longer be undone. */
  forgetSteps(): void;

  on<E extends keyof ViewerEvents>(event: E, listener: (what: ViewerEvents[E]) => void): () => void;

  // Navigation. Deltas are pointer motions in CSS pixels.
  mode: NavigationMode;
  orbit(dx: number, dy: number): void;
  pan(dx: number, dy: number): void;
  look(dx: number, dy: number): void;
  /** Zooms: each step removes a tenth of the distance, towards `pointer` if given. */
  dolly(steps: number, pointer?: readonly [number, number]): void;
  /** Multiplies the flying speed by 1.2 for each step. */
  scaleSpeed(steps: number): void;
  /** Flying speed at factor 1, in world units per second. */
  readonly speed: number;
  /** Whether the view moves smoothly to its target; set it to false for reduced motion. */
  gliding: boolean;
  /** Flies until the next call. `direction` is in the camera's axes (x right, y up, -z forward). */
  fly(direction: Vec3, factor: number): void;
  /** Moves the point under the pointer to the centre. Returns false for the background. */
  focus(x: number, y: number): boolean;
  /** Frames all visible layers from the current direction. */
  frame(): void;
  /** Returns to the first view and the scene's up axis. A canvas narrower than the first recorded camera's image shows
   *  the whole width of this image. */
  home(): void;
  /** Shows the whole scene. `glide`: true by default. */
  showNamedView(view: NamedView, options?: { readonly glide?: boolean }): void;
  /** `index` into SceneSummary.cameras. Throws ViewerError if it is out of range. */
  showCamera(index: number): void;
  setUp(axis: Vec3): void;
  getView(): ViewPose;
  /** `glide`: move smoothly. Throws ViewerError if eye and target are the same point. */
  setView(pose: ViewPose, options?: { readonly glide?: boolean }): void;
  /** The full vertical angle: above 0 and below pi. */
  fov: number;

  /** Moves the view in each frame until the view is moved otherwise, a scene is opened, or stop() is called; a flight that
   *  is no loop ends by itself. `seconds`: of one turn, by default 16, or of the whole flight, by default at an even speed. Throws ViewerError without
   *  a scene, or without recorded cameras for a flight. */
  play(tour: Tour, seconds?: number): void;
  stop(): void;
  readonly playing: Tour | null;

  /** Whether added layers are turned so that their up axis is that of the loaded scene, as the program does. */
  upright: boolean;
  /** Writes the scene as shown: its layers, places, up axis, background, and for html the current view. A worker reads the
   *  sources again. Emits 'progress'. Rejects with ViewerError. */
  write(format: WrittenFormat, options?: { readonly signal?: AbortSignal }): Promise<WrittenScene>;

  // Drawing.
  background: Vec3;
  resolution: Resolution;
  /** Whether, while nothing changes, up to 64 further frames make the image that has 8 x 8 samples per pixel;
   *  screenshots then have them, too. */
  smoothAtRest: boolean;
  /** Selects a debug view; "color" is the final image. Waits for earlier loads and additions. Other debug
   *  views read the scene again, which may take time; a later call overrides an earlier one. `features`: the
   *  features that "features" draws as red, green and blue, `count` 1 to 3 from `first` below
   *  SceneSummary.featureCount. Rejects with ViewerError if the scene does not support the debug view. */
  show(name: string, features?: { readonly first: number; readonly count: number }): Promise<void>;
  readonly debugView: string;
  readonly legend: readonly LegendEntry[];
  /** A PNG of the current view, with the given size or the canvas's size, up to the device's largest image.
   *  Rejects with ViewerError. */
  screenshot(size?: { readonly width: number; readonly height: number }): Promise<Blob>;
  /** Draws a frame immediately. */
  draw(): void;

  dispose(): void;
}

export interface ViewerOptions {
  /** The address of tureen.wasm and the loader's worker, by default next to the script; or functions that
   *  return them. */
  readonly assets?: string | Assets;
  /** The first scene of `load`. It loads while the viewer starts, and so appears sooner. */
  readonly expected?: SceneSource;
  /** Whether pointers, wheel and keys on the canvas move the view; default true. */
  readonly controls?: boolean;
  readonly background?: Vec3;
  readonly resolution?: Resolution;
  /** Default true. */
  readonly smoothAtRest?: boolean;
  /** Default true. */
  readonly upright?: boolean;
  /** Default auto. */
  readonly blend?: SplatBlending;
  /** Memory for the splats of one source, in bytes, above 0. Default: 3 GiB, and on phones a quarter of the memory that the browser
   *  reports, or 1 GiB. */
  readonly memory?: number;
  /** Called before splats are read that need more memory; not for triangle windows and foreign glTF. Resolves to the
   *  number of splats to read, at least 1: those with the largest opacity times area. Rejects to end the load.
   *  `signal`: aborted if the load ends otherwise. The answer holds for all reads of the same source object. Default:
   *  those that fit. */
  readonly chooseSplats?: (offer: SplatOffer, signal: AbortSignal) => Promise<number>;
}
