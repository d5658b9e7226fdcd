// A viewer on a canvas: it shows scenes from loaders, moves the view, and draws a frame after each
// change. The file exceeds 600 lines: one object owns the device's state, and loading, layers, debug
// views and frames all change it.

import { urlOf } from './addresses.js';
import { ArrivingScene } from './arriving_scene.js';
import { assetsAt } from './assets.js';
import { attachControls } from './controls.js';
import { compile, Engine } from './engine.js';
import { FrameTimes } from './frame_times.js';
import type { LoadRole, PreparedScene, SceneDescription } from './loader_messages.js';
import { isShortage, Loading } from './loading.js';
import { defaultMemory } from './memory.js';
import { ResolutionKeeper } from './resolution.js';
import { download } from './download.js';
import { oneFile, openFiles, readWith } from './scene_files.js';
import { SplatSorting } from './splat_sorting.js';
import {
  lowerLevelSentence, nothingDrawn, othersDrawn, sceneSummary, tooLargeSentence, type ShownFacts, type ShownLayer,
} from './scene_summary.js';
import {
  maxLayers, ViewerError, type Assets, type FrameStats, type LegendEntry, type Matrix, type NamedView,
  type NavigationMode, type Placement, type Resolution, type SceneLayer, type SceneSource, type SceneSummary, type SplatOffer,
  type Vec3, type Viewer, type ViewerEvents, type ViewerOptions, type ViewPose,
} from './types.js';

/** Starts the engine on this canvas. Rejects with ViewerError. */
export async function createViewer(canvas: HTMLCanvasElement, options: ViewerOptions = {}): Promise<Viewer> {
  const { assets } = options;
  const parts = typeof assets === 'object' ? assets : assetsAt(assets);
  const { blend = 'auto', memory = defaultMemory(), chooseSplats = async ({ fitting }: SplatOffer) => fitting } = options;
  if (!(memory > 0)) throw new ViewerError(`The memory for splats is ${memory} bytes; it must be above 0.`, 'usage');
  const viewer = new CanvasViewer(canvas, parts, compile(parts),
                                  { blend, memory: Math.min(memory, Number.MAX_VALUE), chooseSplats });
  viewer.smooth = options.smoothAtRest ?? true;
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

/** A source with layers in the scene. */
interface Part {
  readonly source: SceneSource;
  readonly description: SceneDescription;
  /** The reduced lattice level; null if it is not reduced. */
  readonly level: number | null;
}

/** The origin of a layer; its other facts are the engine's. */
interface LayerRecord {
  readonly part: Part;
  /** The layer's number in its source. */
  readonly index: number;
  readonly name: string;
  /** As it was given to setLayer(): the angles of a transform are not unique. Null: computed from the transform. */
  readonly placement: Placement | null;
}

/** `wanted`, or with the first free number: "fox 2". */
function freeName(wanted: string, taken: readonly LayerRecord[]): string {
  const isFree = (name: string) => taken.every((layer) => layer.name !== name);
  if (isFree(wanted)) return wanted;
  for (let number = 2; ; ++number)
    if (isFree(`${wanted} ${number}`)) return `${wanted} ${number}`;
}

/** The file's name for a layer if there are several, otherwise the scene's. */
const ownName = ({ name, layer_names }: SceneDescription, index: number) =>
  (layer_names.length > 1 && layer_names[index]) || name;

const cancelled = () => new ViewerError('Loading was cancelled.', 'cancelled');

/** Listeners of each event. */
type Listeners = { [E in keyof ViewerEvents]?: Set<(what: ViewerEvents[E]) => void> };

class CanvasViewer implements Viewer {
  detach: (() => void) | null = null;

  /** Resolves when the engine and the device are ready. */
  private started!: Promise<void>;
  /** The load of the expected scene, before load() is called. */
  private expected: { readonly source: SceneSource; readonly loading: Loading } | null = null;
  private engine!: Engine;
  private sorting: SplatSorting | null = null;
  private device!: Device;
  private readonly listeners: Listeners = {};
  private readonly times = new FrameTimes();
  private readonly resolutionKeeper = new ResolutionKeeper();
  private readonly observer: ResizeObserver;
  private readonly ending = new AbortController();
  private loading: Loading | null = null;
  /** Resolves when no load runs and no layers are being added. */
  private turn: Promise<unknown> = Promise.resolve();
  /** Number of calls that cancel earlier loads and additions. */
  private cancellations = 0;
  /** The description of the loaded scene, with the background, the up axis and the cameras. */
  private first: SceneDescription | null = null;
  private parts: readonly Part[] = [];  // another list after each change
  private records: readonly LayerRecord[] = [];
  private layers_: readonly SceneLayer[] = [];
  private shown: SceneSummary | null = null;
  private previewed = false;
  /** A large scene whose blocks arrive. */
  private arriving: ArrivingScene | null = null;
  private debugView_ = { name: 'color', features: { first: 0, count: 3 } };
  private debugViewsAsked = 0;
  /** Resolves when no debug view is being shown by show(). */
  private showing: Promise<unknown> = Promise.resolve();
  private opening: { readonly parts: readonly Part[]; readonly done: Promise<void> } | null = null;
  private navigation: NavigationMode = 'orbit';
  private background_: Vec3 = [0, 0, 0];
  private backgroundBefore: Vec3 = [0, 0, 0];
  private gliding_ = true;
  smooth = true;
  /** Numbers of splats that were chosen for sources whose splats do not all fit. */
  private readonly maxSplats = new WeakMap<SceneSource, number>();
  private lost = false;
  /** Whether the view was moved since the last 'view' event. */
  private moved = false;
  private frameAsked = 0;
  private lastFrame: number | null = null;

  constructor(readonly canvas: HTMLCanvasElement, private readonly assets: Assets,
              private readonly program: Promise<WebAssembly.Module>,
              private readonly options: Required<Pick<ViewerOptions, 'blend' | 'memory' | 'chooseSplats'>>) {
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
      this.dropPreview();  // its view and background are not the scene's, which restore() shows again
      this.lost = true;
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
    this.device = engine.call<Device>('start', { blend: this.options.blend });
    this.sorting?.end();
    this.sorting = new SplatSorting(this.assets, this.program, engine, () => this.ask());
    this.lost = false;
    engine.call('background', this.background_);
    engine.call('gliding', this.gliding_);
    engine.call('smooth_at_rest', this.smooth);
    engine.call('mode', this.navigation);
    this.lay();
  }

  /** Starts a new engine and loads the scene again: the old context and the old engine's memory are lost. */
  private async restore(): Promise<void> {
    const view = this.shown ? this.getView() : null, { background, debugView_: shown } = this;
    const { first, parts, layers_: layers } = this;
    try {
      await (this.started = this.startEngine());
      if (this.ending.signal.aborted) return;
      let restored = false;
      for (const { source } of parts) {
        try {
          await (restored ? this.addLayers(source) : this.load(source, {}, first));
          restored = true;
        } catch (error) {
          // The other sources can be restored, unless a load cancelled this one or the device is lost again.
          if (this.isGone || (error instanceof ViewerError && error.kind === 'cancelled')) throw error;
          if (!restored) this.forgetScene();
          this.emit('notice', error instanceof Error ? error.message : String(error));
        }
      }
      if (restored) {
        await this.arrange(layers);
        if (view) {
          this.setView(view);
          this.background = background;
        }
        if (shown.name !== 'color') await this.show(shown.name, shown.features);
      }
    } catch (error) {
      // A load of another scene may have cancelled this one.
      if (!(error instanceof ViewerError && error.kind === 'cancelled')) {
        if (!this.lost) this.engine.call('clear');
        this.forgetScene();
        this.emit('notice', error instanceof Error ? error.message : String(error));
      }
    }
    if (!this.lost) this.emit('context', 'restored');
    this.ask();
  }

  // -- scenes -----------------------------------------------------------------------------------

  get scene(): SceneSummary | null { return this.shown; }

  /** `first`: as in showScene(). */
  load(source: SceneSource, options: { readonly signal?: AbortSignal } = {},
       first: SceneDescription | null = null): Promise<SceneSummary> {
    ++this.cancellations;
    const loaded = this.replace(source, options, first);
    this.turn = loaded.catch(() => {});
    return loaded;
  }

  private async replace(source: SceneSource, options: { readonly signal?: AbortSignal },
                        first: SceneDescription | null = null): Promise<SceneSummary> {
    if (this.isGone) throw new ViewerError('The browser reset the graphics device: try again when it is available.', 'device');
    const { cancellations } = this;
    this.loading?.cancel();
    this.dropArriving();
    this.dropPreview();
    const loading = this.begin(source);
    let layers = 1;
    try {
      await this.run(loading, options.signal, {
        progress: (progress) => this.emit('progress', progress),
        offer: this.offering(source),
        preview: (scene) => this.showPreview(scene),
        // A load that ends must not have changed the shown scene.
        head: (head) => { this.arriving = new ArrivingScene(this.engine, head, this.shown ? [] : null); },
        block: (block) => this.arriving!.take(block),
        scene: (scene) => {
          layers = scene.description.layer_names.length;
          return this.showScene(scene, source, first ?? scene.description);
        },
      });
    } catch (error) {
      if (this.loading === null) {  // no later load has begun
        this.dropArriving();
        this.dropPreview();
      }
      if (layers === 1 || !isShortage(error)) throw error;
      if (this.cancellations !== cancellations) throw cancelled();
      await this.add(source, options.signal, first);  // layer by layer: draws those that fit
    }
    return this.shown!;
  }

  private async run(loading: Loading, signal: AbortSignal | undefined, events: Parameters<Loading['run']>[0]): Promise<void> {
    this.loading = loading;
    const cancel = () => loading.cancel();
    if (signal?.aborted) cancel();
    signal?.addEventListener('abort', cancel);
    try {
      await loading.run(events);
    } finally {
      signal?.removeEventListener('abort', cancel);
      if (this.loading === loading) this.loading = null;
      this.ask();
    }
  }

  private begin(source: SceneSource): Loading {
    const { expected } = this;
    this.expected = null;
    if (expected && isSame(expected.source, source)) return expected.loading;
    expected?.loading.cancel();
    return this.loadingOf(source, this.started.then(() => this.device.limits), 'scene');
  }

  private loadingOf(source: SceneSource, limits: Promise<unknown>, role: LoadRole): Loading {
    return new Loading(this.assets, this.program, limits, source, this.options.memory, this.maxSplats.get(source) ?? null, role);
  }

  /** Asks how many splats of the source to read, and remembers the answer for later reads. */
  private offering(source: SceneSource) {
    return async (offer: SplatOffer, signal: AbortSignal): Promise<number> => {
      const wanted = await this.options.chooseSplats(offer, signal), splats = Math.min(Math.floor(wanted), offer.splats);
      if (!(splats >= 1)) throw new ViewerError(`chooseSplats resolved to ${wanted}, which is below 1.`, 'usage');
      this.maxSplats.set(source, splats);
      return splats;
    };
  }

  private dropArriving(): void {
    if (!this.lost) this.arriving?.drop();
    this.arriving = null;
  }

  private showPreview(scene: PreparedScene): void {
    const before = this.background;
    try {
      this.unpack(scene, 'preview');
    } catch (error) {
      // The memory is too small for two scenes, or the device is lost. The complete scene will replace the old one.
      if (!this.previewed) this.background = before;
      if (isShortage(error) || this.isGone) return;
      throw error;
    }
    if (!this.previewed) this.backgroundBefore = before;
    this.previewed = true;
    this.emit('preview', { triangles: scene.description.triangles, splats: scene.description.splats });
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
    if (this.shown) this.setNoScene();
  }

  private setNoScene(): void {
    this.setScene(null, [], []);
    this.debugView_ = { ...this.debugView_, name: 'color' };
    this.setLayers([]);
    this.emit('scene', null);
    this.emit('layers', []);
  }

  private setScene(first: SceneDescription | null, parts: readonly Part[], records: readonly LayerRecord[]): void {
    this.first = first;
    this.parts = parts;
    this.records = records;
    if (!first) this.shown = null;
  }

  /** Shows a scene with the background, up axis and cameras of `first`. Returns null, or the reason if the
   *  device's memory is too small. */
  private showScene(scene: PreparedScene, source: SceneSource, first: SceneDescription): string | null {
    let facts;
    try {
      const { arriving } = this;
      this.arriving = null;
      if (arriving) this.engine.call('drop_scene');
      arriving?.finish();
      facts = this.unpack({ description: first, parcel: scene.parcel }, 'scene');
    } catch (error) {
      if (this.isGone) throw new ViewerError('The browser reset the graphics device: open the scene again.', 'device');
      this.forgetScene();  // the engine has removed it
      if (isShortage(error)) return error.message;
      throw error;
    }
    this.previewed = false;
    this.debugView_ = { ...this.debugView_, name: 'color' };
    const { description, level } = scene, part = { source, description, level };
    const records: LayerRecord[] = [];
    for (let index = 0; index < facts.layers.length; ++index)
      records.push({ part, index, name: freeName(ownName(description, index), records), placement: null });
    this.setScene(first, [part], records);
    this.showFacts(facts);
    if (facts.drawn === 0) this.emit('notice', nothingDrawn);
    if (scene.level !== null)
      this.emit('notice', lowerLevelSentence(scene.level));
    return null;
  }

  /** Reports a change of the scene's layers. */
  private showFacts(facts: ShownFacts): void {
    this.shown = sceneSummary(this.first!, this.parts.map(({ description }) => description), facts);
    this.setLayers(facts.layers);
    this.emit('scene', this.shown);
    this.emit('layers', this.layers_);
    this.ask();
  }

  /** `shown`: the engine's layers, one for each record. */
  private setLayers(shown: readonly ShownLayer[]): void {
    this.layers_ = this.records.map(({ part, index, name, placement }, at) => {
      const { device_bytes, ...facts } = shown[at]!;
      return {
        name, ...facts, placement: placement ?? facts.placement, deviceBytes: device_bytes,
        source: part.source, sourceLayer: index,
      };
    });
  }

  private unpack({ description, parcel }: Pick<PreparedScene, 'description' | 'parcel'>, role: 'preview' | 'scene'): ShownFacts {
    if (role === 'preview' || !this.previewed) this.background = description.background;
    try {
      return this.engine.give<ShownFacts>(parcel, 'show', { scene: description, role });
    } finally {
      this.engine.call('gliding', this.gliding_);
      this.engine.call('mode', this.navigation);
      this.lay();
      this.ask();
    }
  }

  clear(): void {
    ++this.cancellations;
    this.loading?.cancel();
    if (!this.lost) this.engine.call('clear');
    this.previewed = false;
    this.setNoScene();
    this.ask();
  }

  // -- layers -----------------------------------------------------------------------------------

  get layers(): readonly SceneLayer[] { return this.layers_; }

  addLayers(source: SceneSource, options: { readonly signal?: AbortSignal } = {}): Promise<readonly SceneLayer[]> {
    const { turn, showing, cancellations } = this;
    const added = (async () => {
      await turn;
      await showing;
      if (this.cancellations !== cancellations || options.signal?.aborted) throw cancelled();
      if (this.shown) return this.inColors(() => this.add(source, options.signal));
      await this.replace(source, options);
      return this.layers_;
    })();
    this.turn = added.catch(() => {});
    return added;
  }

  /** Adds the layers of a source; the first is the scene if there is none, with the cameras of `first` if it is
   *  given. If this fails, it adds none. */
  private async add(source: SceneSource, signal: AbortSignal | undefined,
                    first: SceneDescription | null = null): Promise<readonly SceneLayer[]> {
    if (this.isGone) throw new ViewerError('The browser reset the graphics device: try again when it is available.', 'device');
    this.requireRoom(1);
    const refused: string[] = [];
    const loading = this.loadingOf(source, Promise.resolve(this.device.limits), 'layers');
    let part: Part | null = null, total = 0;
    try {
      await this.run(loading, signal, {
        progress: (progress) => this.emit('progress', progress),
        offer: this.offering(source),
        layer: ({ description, parcel, index, forecasts }) => {
          if (index === 0) this.requireRoom(forecasts.length);
          total = forecasts.length;
          part ??= { source, description, level: null };
          const name = freeName(ownName(description, index), this.records);
          let facts;
          try {
            facts = this.shown ? this.engine.give<ShownFacts>(parcel, 'add_layers', {})
                               : this.unpack({ description: first ?? description, parcel }, 'scene');
          } catch (error) {
            if (this.isGone) throw new ViewerError('The browser reset the graphics device: add the layers again.', 'device');
            if (!isShortage(error)) throw error;
            refused.push(tooLargeSentence(name, forecasts[index]!));
            return;
          }
          const parts = this.parts.includes(part) ? this.parts : [...this.parts, part];
          this.setScene(this.first ?? first ?? description, parts, [...this.records, { part, index, name, placement: null }]);
          this.showFacts(facts);
        },
      });
    } catch (error) {
      this.removePart(part);
      throw error;
    }
    if (refused.length === total) throw new ViewerError(refused.join(' '), 'memory');
    for (const sentence of refused) this.emit('notice', `${sentence} ${othersDrawn}`);
    // The user may have removed some of them.
    return this.layers_.filter((_, index) => this.records[index]!.part === part);
  }

  /** Removes the layers of a source whose addition failed. */
  private removePart(part: Part | null): void {
    const kept = this.records.filter((record) => record.part !== part);
    if (kept.length === this.records.length || this.ending.signal.aborted) return;
    if (kept.length === 0) {
      if (!this.isGone) this.engine.call('clear');
      this.forgetScene();
      this.ask();
    } else if (this.isGone) {  // restore() will not add them
      this.layers_ = this.layers_.filter((_, index) => this.records[index]!.part !== part);
      this.setScene(this.first, this.parts.filter((one) => one !== part), kept);
      this.emit('layers', this.layers_);
    } else {
      let facts: ShownFacts | null = null;
      for (let index = this.records.length - 1; index >= 0; --index)
        if (this.records[index]!.part === part) facts = this.engine.call<ShownFacts>('remove_layer', index);
      this.setScene(this.first, this.parts.filter((one) => one !== part), kept);
      this.showFacts(facts!);
    }
  }

  private requireRoom(more: number): void {
    if (this.layers_.length + more <= maxLayers) return;
    throw new ViewerError(`A scene has at most ${maxLayers} layers, and this one would have ` +
                          `${this.layers_.length + more}: remove layers first.`, 'usage');
  }

  private requireLayer(index: number): void {
    if (!(Number.isInteger(index) && index >= 0 && index < this.layers_.length))
      throw new ViewerError(`There is no layer ${index}: the scene has ${this.layers_.length}, counted from 0.`, 'usage');
  }

  setLayer(index: number, change: { readonly visible?: boolean; readonly transform?: Matrix | Placement }): void {
    this.requireLayer(index);
    const { visible, transform } = change;
    const placement = transform && 'position' in transform ? transform : null;
    const matrix = placement ? undefined : transform as Matrix | undefined;
    const numbers = placement ? [...placement.position, ...placement.rotation, placement.scale] : matrix;
    if (numbers && !(numbers.length === (placement ? 7 : 16) && numbers.every(Number.isFinite)))
      throw new ViewerError('A transform needs 16 numbers, column by column, or a position, a rotation and a scale above 0.', 'usage');
    if (this.lost) return;
    const shown = this.engine.call<ShownLayer[]>('set_layer', {
      layer: index, ...(matrix && { transform: matrix }), ...(placement && { placement }), ...(visible !== undefined && { visible }),
    });
    if (transform) this.records = this.records.map((record, at) => (at === index ? { ...record, placement } : record));
    this.setLayers(shown);
    this.emit('layers', this.layers_);
    this.ask();
  }

  async removeLayer(index: number): Promise<void> {
    this.requireLayer(index);
    if (this.layers_.length === 1) return this.clear();
    const leaving = this.records[index]!;
    await this.inColors(() => {
      const at = this.records.indexOf(leaving);
      if (this.lost || at < 0) return;
      const facts = this.engine.call<ShownFacts>('remove_layer', at);
      const records = this.records.filter((record) => record !== leaving);
      this.setScene(this.first, this.parts.filter((part) => records.some((record) => record.part === part)), records);
      this.showFacts(facts);
    });
  }

  async moveLayer(from: number, to: number): Promise<void> {
    this.requireLayer(from);
    this.requireLayer(to);
    if (from === to) return;
    await this.inColors(() => {
      if (this.lost) return;
      this.requireLayer(Math.max(from, to));
      const facts = this.engine.call<ShownFacts>('move_layer', { from, to });
      const records = [...this.records];
      records.splice(to, 0, ...records.splice(from, 1));
      this.setScene(this.first, this.parts, records);
      this.showFacts(facts);
    });
  }

  /** Runs a change of the layers, which needs the colours, and returns to the debug view. */
  private async inColors<T>(change: () => T | Promise<T>): Promise<T> {
    const { name, features } = this.debugView_, { cancellations } = this;
    if (name === 'color') return change();
    await this.showNow('color', features);
    try {
      return await change();
    } finally {
      if (this.shown && !this.lost && this.cancellations === cancellations)
        await this.showNow(name, features).catch((error: unknown) => {
          this.emit('notice', error instanceof Error ? error.message : String(error));
        });
    }
  }

  /** Gives the layers the order, places, visibility and names that `wanted` had; removes the others. */
  private async arrange(wanted: readonly SceneLayer[]): Promise<void> {
    let next = 0;
    for (const { source, sourceLayer, name, transform, placement, visible } of wanted) {
      const at = this.layers_.findIndex((layer, index) =>
        index >= next && layer.source === source && layer.sourceLayer === sourceLayer);
      if (at < 0) continue;  // refused by the device
      await this.moveLayer(at, next);
      this.setLayer(next, { transform, visible });
      this.records = this.records.map((record, index) => (index === next ? { ...record, name, placement } : record));
      ++next;
    }
    while (next > 0 && this.layers_.length > next) await this.removeLayer(next);
    if (next > 0) this.setLayer(0, {});  // reports the names
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

  /** Moves to a view that fits the canvas, whose size may have changed since the last frame. */
  private moveTo(name: string, given: unknown = null): void {
    if (!this.lost) this.lay();
    this.move(name, given);
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
  frame(): void { this.moveTo('frame'); }
  home(): void { this.moveTo('home'); }
  showNamedView(view: NamedView, options: { readonly glide?: boolean } = {}): void {
    this.moveTo('named_view', view);
    if (options.glide === false) this.change('arrive', null);
  }
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

  get smoothAtRest(): boolean { return this.smooth; }
  set smoothAtRest(smooth: boolean) { this.smooth = smooth; this.change('smooth_at_rest', smooth); }

  get debugView(): string { return this.debugView_.name; }
  get legend(): readonly LegendEntry[] { return this.engine.call<LegendEntry[]>('legend'); }

  show(name: string, features = { first: 0, count: 3 }): Promise<void> {
    const { turn } = this, mine = ++this.debugViewsAsked;
    const shown = (async () => {
      await turn;  // layers are added in colours
      if (mine === this.debugViewsAsked) await this.showNow(name, features);
    })();
    this.showing = shown.catch(() => {});
    return shown;
  }

  /** The same, also while layers are added. */
  private async showNow(name: string, features: { readonly first: number; readonly count: number }): Promise<void> {
    const mine = this.debugViewsAsked;
    if (name !== 'color' && !this.engine.call<boolean>('is_read_for_debug_views')) {
      if (!this.opening || this.opening.parts !== this.parts)
        this.opening = { parts: this.parts, done: this.readForDebugViews() };
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

  /** Reads all sources again: the renderer holds too little data for debug views. */
  private async readForDebugViews(): Promise<void> {
    const { parts } = this;
    if (parts.length === 0) throw new ViewerError('There is no scene for a debug view: open one first.', 'usage');
    for (const [index, { source, description: { name }, level }] of parts.entries()) {
      const files = 'url' in source ? oneFile(name, await download(urlOf(source), () => {}))
                                    : await openFiles(source.files, source.name ?? name);
      if (this.parts !== parts) throw new ViewerError('Another scene is open now.', 'cancelled');
      const splats = this.maxSplats.get(source);
      readWith(this.engine, 'read_for_debug_views', files,
               { source: index, ...(level !== null && { level }), ...(splats !== undefined && { max_splats: splats }) });
    }
    this.engine.call('keep_read_layers', this.records.map(({ part, index }) => [parts.indexOf(part), index]));
  }

  get stats(): FrameStats {
    const { width, height } = this.canvas;
    return {
      frameMs: this.times.percentile(50), p95Ms: this.times.percentile(95), submitMs: this.times.submitMs,
      width, height, scale: this.resolutionKeeper.scale, wasmBytes: this.engine.memoryBytes, renderer: this.device.renderer,
    };
  }

  draw(): void { this.drawFrame(performance.now()); }

  /** Sets the viewport of the controls, in CSS pixels. The first view's angle may follow it. */
  private lay(): void {
    const { clientWidth, clientHeight } = this.canvas, { fov } = this;
    if (clientWidth > 0 && clientHeight > 0) this.engine.call('viewport', [clientWidth, clientHeight]);
    if (this.fov !== fov) this.moved = true;
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
    if (this.isGone || this.ending.signal.aborted) return;
    this.fit();
    const seconds = this.lastFrame === null ? 0 : Math.max(now - this.lastFrame, 0) / 1000;
    const before = performance.now();
    let next: number;  // PageView::Next
    try {
      next = this.engine.call<number>('draw', { width: this.canvas.width, height: this.canvas.height, seconds });
    } catch (error) {
      if (this.isGone) return;  // during the frame; restore() asks for the next one
      throw error;
    }
    void this.sorting!.send();
    this.times.add(now, performance.now() - before);
    if (this.lastFrame !== null) this.resolutionKeeper.add(now - this.lastFrame);
    this.emit('frame', this.stats);
    if (next > 0) this.ask();
    if (next === 2) {
      this.lastFrame = now;
    } else {  // frames at rest have no influence on times and resolution
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
    this.sorting?.end();
    cancelAnimationFrame(this.frameAsked);
    if (!this.lost) this.engine.call('clear');
  }
}
