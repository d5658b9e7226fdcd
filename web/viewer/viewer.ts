// A viewer on a canvas: it shows scenes from loaders, moves the view, and draws a frame after each
// change.

import { urlOf } from './addresses.js';
import { assetsAt, type Assets } from './assets.js';
import { attachControls } from './controls.js';
import { compile, Engine } from './engine.js';
import { FrameTimes } from './frame_times.js';
import type { PreparedScene } from './loader_messages.js';
import { isShortage, Loading } from './loading.js';
import { ResolutionKeeper } from './resolution.js';
import { download } from './download.js';
import { oneFile, openFiles, readWith } from './scene_files.js';
import { lowerLevelSentence, nothingDrawn, sceneSummary, type ShownFacts } from './scene_summary.js';
import {
  ViewerError, type FrameStats, type LegendEntry, type NamedView, type NavigationMode, type Resolution,
  type SceneSource, type SceneSummary, type Vec3, type Viewer, type ViewerEvents, type ViewerOptions, type ViewPose,
} from './types.js';

/** Starts the engine on this canvas. Rejects with ViewerError. */
export async function createViewer(canvas: HTMLCanvasElement, options: ViewerOptions = {}): Promise<Viewer> {
  const { assets } = options;
  const parts = typeof assets === 'object' ? assets : assetsAt(assets);
  const viewer = new CanvasViewer(canvas, parts, compile(parts));
  await viewer.start(options.expected ?? null);
  if (options.background) viewer.background = options.background;
  if (options.resolution) viewer.resolution = options.resolution;
  if (options.controls !== false) viewer.detach = attachControls(canvas, viewer);
  return viewer;
}

interface Device {
  readonly renderer: string;
  readonly limits: unknown;
  readonly max_image_side: number;
}

/** Whether both are the same file on a server, or the same object with local files. */
const isSame = (a: SceneSource, b: SceneSource) =>
  a === b || ('url' in a && 'url' in b && urlOf(a) === urlOf(b) && a.name === b.name);

/** Listeners of each event. */
type Listeners = { [E in keyof ViewerEvents]?: Set<(what: ViewerEvents[E]) => void> };

class CanvasViewer implements Viewer {
  detach: (() => void) | null = null;

  /** Resolves when the engine and the device are ready. */
  private started!: Promise<void>;
  /** The load of the expected scene, before load() is called. */
  private expected: { readonly source: SceneSource; readonly loading: Loading } | null = null;
  private engine!: Engine;
  private device!: Device;
  private readonly listeners: Listeners = {};
  private readonly times = new FrameTimes();
  private readonly resolutionKeeper = new ResolutionKeeper();
  private readonly observer: ResizeObserver;
  private readonly ending = new AbortController();
  private loading: Loading | null = null;
  private source: SceneSource | null = null;
  private level: number | null = null;  // the reduced lattice level of the scene
  private shown: SceneSummary | null = null;
  private previewed = false;
  private debugView_ = { name: 'color', features: { first: 0, count: 3 } };
  private debugViewsAsked = 0;
  private opening: { readonly source: SceneSource | null; readonly done: Promise<void> } | null = null;
  private navigation: NavigationMode = 'orbit';
  private background_: Vec3 = [0, 0, 0];
  private backgroundBefore: Vec3 = [0, 0, 0];
  private gliding_ = true;
  private lost = false;
  /** Whether the view was moved since the last 'view' event. */
  private moved = false;
  private frameAsked = 0;
  private lastFrame: number | null = null;

  constructor(readonly canvas: HTMLCanvasElement, private readonly assets: Assets,
              private readonly program: Promise<WebAssembly.Module>) {
    this.observer = new ResizeObserver(() => this.ask());
  }

  async start(expected: SceneSource | null): Promise<void> {
    this.started = this.startEngine();
    if (expected) this.expected = { source: expected, loading: this.begin(expected) };
    await this.started;
    this.observer.observe(this.canvas);
    const signal = this.ending.signal;
    this.canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();  // otherwise the browser does not restore the context
      this.lost = true;
      this.previewed = false;
      this.loading?.cancel(new ViewerError(
        'The browser reset the graphics device while the scene was loading: open the scene again.', 'device'));
      this.emit('context', 'lost');
    }, { signal });
    this.canvas.addEventListener('webglcontextrestored', () => void this.restore(), { signal });
    document.addEventListener('visibilitychange', () => {
      this.lastFrame = null;  // the time while hidden does not count
      this.ask();
    }, { signal });
  }

  private async startEngine(): Promise<void> {
    const engine = await Engine.create(await this.program);
    engine.takeCanvas(this.canvas);
    this.engine = engine;
    this.device = engine.call<Device>('start');
    this.lost = false;
    engine.call('background', this.background_);
    engine.call('gliding', this.gliding_);
    engine.call('mode', this.navigation);
    this.lay();
  }

  /** Starts a new engine and loads the scene again: the old context and the old engine's memory are lost. */
  private async restore(): Promise<void> {
    const view = this.shown ? this.getView() : null, source = this.source, shown = this.debugView_;
    try {
      await (this.started = this.startEngine());
      if (this.ending.signal.aborted) return;
      if (source) {
        await this.load(source);
        if (view) this.setView(view);
        if (shown.name !== 'color') await this.show(shown.name, shown.features);
      }
    } catch (error) {
      // A load of another scene may have cancelled this one.
      if (!(error instanceof ViewerError && error.kind === 'cancelled')) {
        this.forgetScene();
        this.emit('notice', error instanceof Error ? error.message : String(error));
      }
    }
    if (!this.lost) this.emit('context', 'restored');
    this.ask();
  }

  // -- scenes -----------------------------------------------------------------------------------

  get scene(): SceneSummary | null { return this.shown; }

  async load(source: SceneSource, options: { readonly signal?: AbortSignal } = {}): Promise<SceneSummary> {
    if (this.isGone) throw new ViewerError('The browser reset the graphics device: try again when it is available.', 'device');
    this.loading?.cancel();
    this.dropPreview();
    const loading = this.loading = this.begin(source);
    const cancel = () => loading.cancel();
    if (options.signal?.aborted) cancel();
    options.signal?.addEventListener('abort', cancel);
    try {
      await loading.run({
        progress: (progress) => this.emit('progress', progress),
        preview: (scene) => this.showPreview(scene),
        scene: (scene) => this.showScene(scene, source),
      });
    } catch (error) {
      if (this.loading === loading) this.dropPreview();
      throw error;
    } finally {
      options.signal?.removeEventListener('abort', cancel);
      if (this.loading === loading) this.loading = null;
      this.ask();
    }
    return this.shown!;
  }

  private begin(source: SceneSource): Loading {
    const { expected } = this;
    this.expected = null;
    if (expected && isSame(expected.source, source)) return expected.loading;
    expected?.loading.cancel();
    return new Loading(this.assets, this.program, this.started.then(() => this.device.limits), source);
  }

  private showPreview(scene: PreparedScene): void {
    const before = this.background;
    try {
      this.unpack(scene, 'preview');
    } catch (error) {
      // The memory is too small for two scenes, or the device is lost. The complete scene will replace the old one.
      if (isShortage(error) || this.isGone) return;
      throw error;
    }
    if (!this.previewed) this.backgroundBefore = before;
    this.previewed = true;
    this.emit('preview', { triangles: scene.description.triangles });
  }

  /** Whether the context is lost, even before the event arrives. */
  private get isGone(): boolean { return this.lost || (this.canvas.getContext('webgl2')?.isContextLost() ?? false); }

  /** Removes the preview and shows the scene before it. */
  private dropPreview(): void {
    if (!this.previewed) return;
    this.previewed = false;
    this.engine.call('drop_preview');
    this.background = this.backgroundBefore;
    this.emit('scene', this.shown);
    this.moved = true;  // the view has changed too
    this.ask();
  }

  private forgetScene(): void {
    if (!this.shown) return;
    this.source = this.shown = null;
    this.emit('scene', null);
  }

  /** Shows a scene. Returns null, or the reason if the device's memory is too small. */
  private showScene(scene: PreparedScene, source: SceneSource): string | null {
    let facts;
    try {
      facts = this.unpack(scene, 'scene');
    } catch (error) {
      if (this.isGone) throw new ViewerError('The browser reset the graphics device: open the scene again.', 'device');
      this.forgetScene();  // the engine has removed it
      if (isShortage(error)) return error.message;
      throw error;
    }
    this.previewed = false;
    this.source = source;
    this.level = scene.level;
    this.debugView_ = { ...this.debugView_, name: 'color' };
    this.shown = sceneSummary(scene, facts);
    this.emit('scene', this.shown);
    if (facts.drawn === 0) this.emit('notice', nothingDrawn);
    if (scene.level !== null)
      this.emit('notice', lowerLevelSentence(scene.level));
    return null;
  }

  private unpack(scene: PreparedScene, role: 'preview' | 'scene'): ShownFacts {
    const { description, parcel } = scene;
    this.engine.setBuffer(new Uint8Array(parcel.head));
    this.engine.call('take_head');
    this.engine.setBlobs(parcel.blobs);
    if (role === 'preview' || !this.previewed) this.background = description.background;
    try {
      return this.engine.call<ShownFacts>('show', { scene: description, role });
    } finally {
      this.engine.setBlobs([]);
      this.engine.call('gliding', this.gliding_);
      this.engine.call('mode', this.navigation);
      this.lay();
      this.ask();
    }
  }

  clear(): void {
    this.loading?.cancel();
    if (!this.lost) this.engine.call('clear');
    this.previewed = false;
    this.source = this.shown = null;
    this.debugView_ = { ...this.debugView_, name: 'color' };
    this.emit('scene', null);
    this.ask();
  }

  // -- events -----------------------------------------------------------------------------------

  on<E extends keyof ViewerEvents>(event: E, listener: (what: ViewerEvents[E]) => void): () => void {
    const those = (this.listeners[event] ??= new Set() as Listeners[E])!;
    those.add(listener);
    return () => those.delete(listener);
  }

  private emit<E extends keyof ViewerEvents>(event: E, what: ViewerEvents[E]): void {
    for (const listener of [...this.listeners[event] ?? []]) {
      try {
        listener(what);
      } catch (error) {
        reportError(error);  // an error in the listener, not in the scene
      }
    }
  }

  // -- navigation -------------------------------------------------------------------------------

  private change(name: string, given: unknown): void {
    if (this.lost) return;
    this.engine.call(name, given);
    this.ask();
  }

  private move(name: string, given: unknown = null): void {
    this.change(name, given);
    this.moved = true;
  }

  get mode(): NavigationMode { return this.navigation; }
  set mode(mode: NavigationMode) {
    if (mode !== 'orbit' && mode !== 'fly') throw new ViewerError(`“${String(mode)}” is not a mode: use orbit or fly.`, 'usage');
    this.navigation = mode;
    this.change('mode', mode);
  }
  orbit(dx: number, dy: number): void { this.move('orbit', [dx, dy]); }
  pan(dx: number, dy: number): void { this.move('pan', [dx, dy]); }
  look(dx: number, dy: number): void { this.move('turn_head', [dx, dy]); }
  dolly(steps: number, pointer?: readonly [number, number]): void { this.move('dolly', [steps, ...(pointer ?? [])]); }
  scaleSpeed(steps: number): void { this.move('scale_speed', [steps]); }
  get speed(): number { return this.engine.call<number>('speed'); }
  fly(direction: Vec3, factor: number): void { this.move('fly', [direction, factor]); }
  focus(x: number, y: number): boolean {
    if (this.lost) return false;
    const found = this.engine.call<boolean>('focus', [x, y, this.canvas.clientWidth, this.canvas.clientHeight]);
    if (found) this.moved = true;
    this.ask();
    return found;
  }
  frame(): void { this.move('frame'); }
  home(): void { this.move('home'); }
  showNamedView(view: NamedView): void { this.move('named_view', view); }
  showCamera(index: number): void { this.move('camera', index); }
  setUp(axis: Vec3): void { this.move('up', axis); }
  getView(): ViewPose { return this.engine.call<ViewPose>('pose'); }
  setView(pose: ViewPose, options: { readonly glide?: boolean } = {}): void {
    this.move('set_pose', { pose, glide: options.glide ?? false });
  }
  get fov(): number { return this.getView().fov; }
  set fov(fov: number) { this.move('fov', fov); }
  get gliding(): boolean { return this.gliding_; }
  set gliding(gliding: boolean) { this.gliding_ = gliding; this.change('gliding', gliding); }

  // -- drawing ----------------------------------------------------------------------------------

  get background(): Vec3 { return this.background_; }
  set background(color: Vec3) { this.background_ = color; this.change('background', color); }

  get resolution(): Resolution { return this.resolutionKeeper.resolution; }
  set resolution(resolution: Resolution) { this.resolutionKeeper.resolution = resolution; this.ask(); }

  get debugView(): string { return this.debugView_.name; }
  get legend(): readonly LegendEntry[] { return this.engine.call<LegendEntry[]>('legend'); }

  async show(name: string, features = { first: 0, count: 3 }): Promise<void> {
    const mine = ++this.debugViewsAsked;
    if (name !== 'color' && !this.engine.call<boolean>('is_read_for_debug_views')) {
      if (!this.opening || this.opening.source !== this.source)
        this.opening = { source: this.source, done: this.readForDebugViews() };
      const { opening } = this;
      try {
        await opening.done;
      } finally {
        if (this.opening === opening) this.opening = null;  // keep one for another scene that began later
      }
      if (mine !== this.debugViewsAsked) return;  // a later call overrides this one
    }
    this.engine.call('debug_view', { name, ...features });
    this.debugView_ = { name, features };
    this.drawFrame(performance.now());
  }

  /** Reads the scene again: the renderer holds too little data for debug views. */
  private async readForDebugViews(): Promise<void> {
    const source = this.source;
    if (!source) throw new ViewerError('There is no scene for a debug view: open one first.', 'usage');
    const name = this.shown!.name;
    const files = 'url' in source ? oneFile(name, await download(urlOf(source), () => {}))
                                  : await openFiles(source.files, source.name ?? name);
    if (this.source !== source) throw new ViewerError('Another scene is open now.', 'cancelled');
    readWith(this.engine, 'read_for_debug_views', files, this.level === null ? {} : { level: this.level });
  }

  get stats(): FrameStats {
    const { width, height } = this.canvas;
    return {
      frameMs: this.times.percentile(50), p95Ms: this.times.percentile(95), submitMs: this.times.submitMs,
      width, height, scale: this.resolutionKeeper.scale, wasmBytes: this.engine.memoryBytes, renderer: this.device.renderer,
    };
  }

  draw(): void { this.drawFrame(performance.now()); }

  /** Sets the viewport of the controls, in CSS pixels. */
  private lay(): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth > 0 && clientHeight > 0) this.engine.call('viewport', [clientWidth, clientHeight]);
  }

  /** Fits the canvas to its CSS size. A new size clears the canvas, so a frame must follow. */
  private fit(): void {
    const scale = this.resolutionKeeper.scale * devicePixelRatio, most = this.device.max_image_side;
    const side = (css: number) => Math.min(Math.max(Math.round(css * scale), 1), most);
    const width = side(this.canvas.clientWidth), height = side(this.canvas.clientHeight);
    if (this.canvas.width === width && this.canvas.height === height) return;
    this.canvas.width = width;
    this.canvas.height = height;
    this.lay();
  }

  private ask(): void {
    if (this.frameAsked === 0 && !this.ending.signal.aborted)
      this.frameAsked = requestAnimationFrame((now) => this.drawFrame(now));
  }

  private drawFrame(now: number): void {
    cancelAnimationFrame(this.frameAsked);
    this.frameAsked = 0;
    if (this.lost || this.ending.signal.aborted) return;
    this.fit();
    const seconds = this.lastFrame === null ? 0 : Math.max(now - this.lastFrame, 0) / 1000;
    const before = performance.now();
    const goesOn = this.engine.call<boolean>('draw', { width: this.canvas.width, height: this.canvas.height, seconds });
    this.times.add(now, performance.now() - before);
    if (this.lastFrame !== null) this.resolutionKeeper.add(now - this.lastFrame);
    this.emit('frame', this.stats);
    if (goesOn) {
      this.lastFrame = now;
      this.ask();
    } else {
      this.lastFrame = null;
      this.times.stop();
      if (this.moved && this.shown) {
        this.moved = false;
        this.emit('view', this.getView());
      }
    }
  }

  async screenshot(size?: { readonly width: number; readonly height: number }): Promise<Blob> {
    this.fit();
    const { width, height } = size ?? this.canvas, most = this.device.max_image_side;
    if (![width, height].every((side) => Number.isInteger(side) && side >= 1 && side <= most))
      throw new ViewerError(`The sides of an image must be from 1 to ${most} pixels, not ${width} and ${height}.`, 'usage');
    this.engine.call('picture', { width, height });
    const pixels = new Uint8ClampedArray(this.engine.buffer());
    this.ask();
    const canvas = new OffscreenCanvas(width, height);
    canvas.getContext('2d')!.putImageData(new ImageData(pixels, width, height), 0, 0);
    return canvas.convertToBlob({ type: 'image/png' });
  }

  dispose(): void {
    this.ending.abort();
    this.detach?.();
    this.observer.disconnect();
    this.loading?.cancel();
    this.expected?.loading.cancel();
    cancelAnimationFrame(this.frameAsked);
    if (!this.lost) this.engine.call('clear');
  }
}
