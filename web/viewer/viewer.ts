// A viewer on a canvas: it shows scenes from loaders, moves the view, and draws a frame after each
// change. The file exceeds 600 lines: one object owns the device's state, and loading, layers, debug
// views and frames all change it.

import { urlOf } from './addresses.js';
import { ArrivingScene } from './arriving_scene.js';
import { assetsAt } from './assets.js';
import { attachControls } from './controls.js';
import { compile, Engine, type Parcel } from './engine.js';
import { FrameTimes } from './frame_times.js';
import type { PreparedLayer, PreparedScene, SceneDescription, WantedLayers } from './loader_messages.js';
import { isShortage, Loading, sourceToLoad } from './loading.js';
import { defaultMemory } from './memory.js';
import { ResolutionKeeper } from './resolution.js';
import { download } from './download.js';
import { oneFile, openFiles, readWith, type OpenedFiles } from './scene_files.js';
import { SplatSorting } from './splat_sorting.js';
import {
  lowerLevelSentence, nothingDrawn, othersDrawn, sceneSummary, tooLargeSentence, type ShownFacts,
} from './scene_summary.js';
import {
  maxLayers, ViewerError, writtenFormats, type Assets, type FrameStats, type LegendEntry, type Matrix, type NamedView,
  type NavigationMode, type Placement, type Resolution, type SceneBox, type SceneLayer, type SceneSource, type SceneSummary, type SplatOffer,
  type Steps, type Tour, type Vec3, type Viewer, type ViewerEvents, type ViewerOptions, type ViewPose, type WrittenFormat, type WrittenScene,
} from './types.js';
import { pageWith, writeFile } from './writing.js';

/** Starts the engine on this canvas. Rejects with ViewerError. */
export async function createViewer(canvas: HTMLCanvasElement, options: ViewerOptions = {}): Promise<Viewer> {
  const { assets } = options;
  const parts = typeof assets === 'object' ? assets : assetsAt(assets);
  const { blend = 'auto', memory = defaultMemory(), chooseSplats = async ({ fitting }: SplatOffer) => fitting } = options;
  if (!(memory > 0)) throw new ViewerError(`The memory for splats is ${memory} bytes; it must be above 0.`, 'usage');
  const viewer = new CanvasViewer(canvas, parts, compile(parts),
                                  { blend, memory: Math.min(memory, Number.MAX_VALUE), chooseSplats });
  viewer.smooth = options.smoothAtRest ?? true;
  viewer.upright = options.upright ?? true;
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
  a === b || ('url' in a && 'url' in b && urlOf(a) === urlOf(b) && a.name === b.name && a.lod === b.lod);

/** A source that was read. */
interface Part {
  readonly source: SceneSource;
  readonly description: SceneDescription;
  /** The reduced lattice level; null if it is not reduced. */
  readonly level: number | null;
}

/** The origin of a layer: its number in its source. */
interface LayerOrigin {
  readonly part: Part;
  readonly index: number;
}

/** Further arguments of calls that read sources. */
interface Cancelling { readonly signal?: AbortSignal }

/** `wanted`, or with the first free number: "fox 2". */
function freeName(wanted: string, taken: readonly string[]): string {
  if (!taken.includes(wanted)) return wanted;
  for (let number = 2; ; ++number)
    if (!taken.includes(`${wanted} ${number}`)) return `${wanted} ${number}`;
}

/** The file's name for a layer if there are several, otherwise the scene's; with a number if it is taken. */
const nameOf = ({ name, layer_names }: SceneDescription, index: number, taken: readonly string[]) =>
  freeName((layer_names.length > 1 && layer_names[index]) || name, taken);

const namesOf = (description: SceneDescription) => {
  const names: string[] = [];
  for (const index of description.layer_names.keys()) names.push(nameOf(description, index, names));
  return names;
};

const reason = (error: unknown) => (error instanceof Error ? error.message : String(error));
const isCancelled = (error: unknown) => error instanceof ViewerError && error.kind === 'cancelled';
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
  /** Ends reading the sources again for a debug view. */
  private rereading = new AbortController();
  private loading: Loading | null = null;
  /** Resolves when no load runs, no layers are being added, and no step is under way. */
  private turn: Promise<unknown> = Promise.resolve();
  /** Number of calls that cancel earlier loads, additions and steps. */
  private cancellations = 0;
  /** The description of the loaded scene, with the background, the up axis and the cameras. */
  private first: SceneDescription | null = null;
  /** The origins of all layers, by id: those that the engine's document has, and removed ones, which may return. */
  private readonly origins = new Map<number, LayerOrigin>();
  /** Number of scenes that were shown or removed. */
  private generation = 0;
  private shown: SceneSummary | null = null;
  private previewed = false;
  /** A large scene whose blocks arrive. */
  private arriving: ArrivingScene | null = null;
  private debugView_ = { name: 'color', features: { first: 0, count: 3 } };
  private debugViewsAsked = 0;
  /** Resolves when no debug view is being shown by show(). */
  private showing: Promise<unknown> = Promise.resolve();
  private opening: { readonly generation: number; readonly done: Promise<void> } | null = null;
  private navigation: NavigationMode = 'orbit';
  private holding_ = false;
  private gliding_ = true;
  smooth = true;
  upright = true;
  private playing_: Tour | null = null;
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
      this.arriving = null;
      this.engine.call('lose_device');
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
    this.engine = await Engine.create(await this.program);
    this.sorting = new SplatSorting(this.assets, this.program, this.engine, () => this.ask());
    this.startDevice();
  }

  private startDevice(): void {
    this.engine.takeCanvas(this.canvas);
    this.device = this.engine.call<Device>('start', { blend: this.options.blend });
    this.lost = false;
    this.engine.call('gliding', this.gliding_);
    this.engine.call('smooth_at_rest', this.smooth);
    this.engine.call('mode', this.navigation);
    this.lay();
  }

  /** Reads the layers of the document again: the old context is lost. The engine has all else. */
  private async restore(): Promise<void> {
    const { debugView_: shown } = this;
    this.debugView_ = { ...shown, name: 'color' };
    try {
      this.startDevice();
      if (this.shown) await this.readAllAgain();
      if (this.shown && shown.name !== 'color') await this.show(shown.name, shown.features);
    } catch (error) {
      if (!isCancelled(error)) {  // a load of another scene may have cancelled this one
        this.removeScene();
        this.emit('notice', reason(error));
      }
    }
    if (!this.lost) this.emit('context', 'restored');
    this.ask();
  }

  private async readAllAgain(): Promise<void> {
    const lost: number[] = [], { generation } = this;
    for (const [part, ids] of this.byPart(this.engine.call<number[]>('missing'))) {
      try {
        await this.uploadAgain(part, ids);
      } catch (error) {
        // The other sources can be restored, unless a load cancelled this one or the device is lost again.
        if (this.isGone || isCancelled(error)) throw error;
        lost.push(...ids);
        this.emit('notice', reason(error));
      }
      if (this.generation !== generation) throw cancelled();
    }
    if (lost.length === this.layers.length) return this.removeScene();
    this.engine.call('give_up', lost);
    this.report();
  }

  // -- scenes -----------------------------------------------------------------------------------

  get scene(): SceneSummary | null { return this.shown; }

  load(source: SceneSource, options: Cancelling = {}): Promise<SceneSummary> {
    ++this.cancellations;
    this.rereading.abort();
    const loaded = this.replace(source, options);
    this.turn = loaded.catch(() => {});
    return loaded;
  }

  private async replace(source: SceneSource, options: Cancelling): Promise<SceneSummary> {
    this.requireDevice();
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
          return this.showScene(scene, source);
        },
      });
    } catch (error) {
      if (this.loading === null) {  // no later load has begun
        this.dropArriving();
        this.dropPreview();
      }
      if (layers === 1 || !isShortage(error)) throw error;
      if (this.cancellations !== cancellations) throw cancelled();
      await this.add(source, options.signal);  // layer by layer: draws those that fit
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

  private loadingOf(source: SceneSource, limits: Promise<unknown>, role: 'scene' | WantedLayers): Loading {
    const up = this.upright && role !== 'scene' ? this.first?.file_up ?? null : null;
    return new Loading(this.assets, this.program, limits, source, this.options.memory, this.maxSplats.get(source) ?? null, role, up);
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
    try {
      this.unpack(scene.description, scene.parcel, 'preview');
    } catch (error) {
      // The memory is too small for two scenes, or the device is lost. The complete scene will replace the old one.
      if (isShortage(error) || this.isGone) return;
      throw error;
    }
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
    this.emit('scene', this.shown);
    this.moved = true;  // the view has changed too
    this.ask();
  }

  /** Removes the scene. */
  private removeScene(): void {
    this.engine.call('clear');
    if (this.shown) this.forgetScene();
    this.ask();
  }

  private forgetScene(): void {
    this.engine.call('drop_scene');
    this.endTour();
    this.first = this.shown = null;
    this.origins.clear();
    ++this.generation;
    this.debugView_ = { ...this.debugView_, name: 'color' };
    this.emit('scene', null);
    this.reportLayers();
  }

  /** Shows a scene. Returns null, or the reason if the device's memory is too small. */
  private showScene({ description, parcel, level }: PreparedScene, source: SceneSource): string | null {
    try {
      const { arriving } = this;
      this.arriving = null;
      if (arriving) this.engine.call('drop_scene');
      arriving?.finish();
      this.beginScene({ source, description, level }, parcel, namesOf(description), 0);
    } catch (error) {
      if (this.isGone) throw new ViewerError('The browser reset the graphics device: open the scene again.', 'device');
      if (this.shown) this.forgetScene();  // the device held only one of them
      if (isShortage(error)) return error.message;
      throw error;
    }
    if (this.engine.call<ShownFacts>('facts').drawn === 0) this.emit('notice', nothingDrawn);
    if (level !== null) this.emit('notice', lowerLevelSentence(level));
    return null;
  }

  /** Shows layers of a source instead of the scene: those from number `from` on, with these names. */
  private beginScene(part: Part, parcel: Parcel, names: readonly string[], from: number): void {
    this.unpack(part.description, parcel, 'scene', names);
    this.previewed = false;
    this.debugView_ = { ...this.debugView_, name: 'color' };
    this.first = part.description;
    this.endTour();
    this.origins.clear();
    ++this.generation;
    this.engine.call<SceneLayer[]>('layers').forEach(({ id }, at) => this.origins.set(id, { part, index: from + at }));
    this.report();
  }

  /** The sources of the layers, those that came first in front. */
  private parts(): readonly Part[] { return [...this.byPart(this.layers.map(({ id }) => id)).keys()]; }

  private byPart(ids: readonly number[]): ReadonlyMap<Part, readonly number[]> {
    const parts = new Map<Part, number[]>();
    for (const id of [...ids].sort((a, b) => a - b)) {
      const { part } = this.origins.get(id)!;
      parts.set(part, [...parts.get(part) ?? [], id]);
    }
    return parts;
  }

  /** Reports a change of the scene's layers. */
  private report(): void {
    const descriptions = this.parts().map(({ description }) => description);
    this.shown = sceneSummary(this.first!, descriptions, this.layers, this.engine.call<ShownFacts>('facts'));
    this.emit('scene', this.shown);
    this.reportLayers();
  }

  private reportLayers(): void {
    if (this.listeners.layers?.size) this.emit('layers', this.layers);
    this.reportStep();
  }

  private reportStep(): void {
    if (this.listeners.steps?.size) this.emit('steps', this.steps);
    this.ask();
  }

  private unpack(scene: SceneDescription, parcel: Parcel, role: 'preview' | 'scene', names: readonly string[] = []): void {
    try {
      this.engine.give(parcel, 'show', { scene, role, names });
    } finally {
      this.engine.call('gliding', this.gliding_);
      this.engine.call('mode', this.navigation);
      this.lay();
      this.ask();
    }
  }

  clear(): void {
    ++this.cancellations;
    this.rereading.abort();
    this.loading?.cancel();
    this.previewed = false;
    this.engine.call('clear');
    this.forgetScene();
  }

  // -- layers -----------------------------------------------------------------------------------

  get layers(): readonly SceneLayer[] {
    return this.engine.call<Omit<SceneLayer, 'source' | 'sourceLayer'>[]>('layers').map((layer) => {
      const { part, index } = this.origins.get(layer.id)!;
      return { ...layer, source: part.source, sourceLayer: index };
    });
  }

  get box(): SceneBox | null { return this.shown && this.engine.call<SceneBox>('box'); }

  /** Runs `what` after earlier loads, additions, steps and debug views. load(), clear() and the signal cancel it. */
  private inTurn<T>({ signal }: Cancelling, what: () => T | Promise<T>): Promise<T> {
    const { turn, showing, cancellations } = this;
    const done = (async () => {
      await turn;
      await showing;
      if (this.cancellations !== cancellations || signal?.aborted) throw cancelled();
      return what();
    })();
    this.turn = done.catch(() => {});
    return done;
  }

  addLayers(source: SceneSource, options: Cancelling = {}): Promise<readonly SceneLayer[]> {
    return this.inTurn(options, async () => {
      if (this.shown) return this.inColors(() => this.add(source, options.signal));
      await this.replace(source, options);
      return this.layers;
    });
  }

  /** Adds the layers of a source; they are the scene if there is none. If this fails, it adds none. */
  private async add(source: SceneSource, signal: AbortSignal | undefined): Promise<readonly SceneLayer[]> {
    this.requireRoom(1);
    const refused: string[] = [], opens = !this.shown, before = this.layers;
    const names = before.map(({ name }) => name), indices: number[] = [];
    let part: Part | null = null;
    try {
      await this.readLayers(source, { indices: null, level: null }, signal, ({ description, parcel, index, forecast, count }) => {
        if (index === 0) this.requireRoom(count);
        part ??= { source, description, level: null };
        const name = nameOf(description, index, names);
        try {
          if (this.shown) {
            this.upload(parcel, { name });
            indices.push(index);
          } else {
            this.takeArriving();
            this.beginScene(part, parcel, [name], index);
          }
          names.push(name);
        } catch (error) {
          if (this.isGone) throw new ViewerError('The browser reset the graphics device: add the layers again.', 'device');
          if (!isShortage(error)) throw error;
          refused.push(tooLargeSentence(name, forecast));
        }
      });
      if (names.length === before.length) throw new ViewerError(refused.join(' '), 'memory');
    } catch (error) {
      if (!opens) this.engine.call('drop_uploaded');
      else if (this.shown && !this.ending.signal.aborted) this.removeScene();
      throw error;
    }
    this.engine.call<number[]>('add_uploaded', !opens).forEach((id, at) => this.origins.set(id, { part: part!, index: indices[at]! }));
    this.report();
    for (const sentence of refused) this.emit('notice', `${sentence} ${othersDrawn}`);
    return this.layers.slice(-(names.length - before.length));
  }

  /** Reads a source and passes its layers on, prepared, one after the other. */
  private async readLayers(source: SceneSource, wanted: WantedLayers, signal: AbortSignal | undefined,
                           layer: (layer: PreparedLayer) => void): Promise<void> {
    this.requireDevice();
    try {
      await this.run(this.loadingOf(source, Promise.resolve(this.device.limits), wanted), signal, {
        progress: (progress) => this.emit('progress', progress),
        offer: this.offering(source),
        head: (head) => { this.arriving = new ArrivingScene(this.engine, head, null); },
        block: (block) => this.arriving!.take(block),
        layer,
      });
    } finally {
      if (this.loading === null) this.dropArriving();
    }
  }

  private takeArriving(): void {
    const { arriving } = this;
    this.arriving = null;
    arriving?.finish();
  }

  /** Uploads a layer, which its step will show. `what`: its id, or the name of a new layer. */
  private upload(parcel: Parcel, what: { readonly id: number } | { readonly name: string }): void {
    this.takeArriving();
    this.engine.give(parcel, 'upload_layer', what);
  }

  /** Reads layers of a source again and uploads them under their ids. */
  private uploadAgain({ source, level }: Part, ids: readonly number[], signal?: AbortSignal): Promise<void> {
    const indices = ids.map((id) => this.origins.get(id)!.index);
    return this.readLayers(source, { indices, level }, signal, ({ parcel, index }) =>
      this.upload(parcel, { id: ids[indices.indexOf(index)]! }));
  }

  private requireDevice(): void {
    if (this.isGone) throw new ViewerError('The browser reset the graphics device: try again when it is available.', 'device');
  }

  private requireRoom(more: number): void {
    const count = this.layers.length + more;
    if (count <= maxLayers) return;
    throw new ViewerError(`A scene has at most ${maxLayers} layers, and this one would have ${count}: remove layers first.`, 'usage');
  }

  private layerAt(index: number): SceneLayer {
    const { layers } = this, layer = layers[index];
    if (layer) return layer;
    throw new ViewerError(`There is no layer ${index}: the scene has ${layers.length}, counted from 0.`, 'usage');
  }

  setLayer(index: number, change: { readonly visible?: boolean; readonly transform?: Matrix | Placement }): void {
    const { id } = this.layerAt(index), { visible, transform } = change;
    const placement = transform && 'position' in transform ? transform : null;
    const matrix = placement ? undefined : transform as Matrix | undefined;
    const numbers = placement ? [...placement.position, ...placement.rotation, placement.scale] : matrix;
    if (numbers && !(numbers.length === (placement ? 7 : 16) && numbers.every(Number.isFinite)))
      throw new ViewerError('A transform needs 16 numbers, column by column, or a position, a rotation and a scale above 0.', 'usage');
    if (this.lost) return;
    this.engine.call('set_layer', {
      layer: id, ...(matrix && { transform: matrix }), ...(placement && { placement }), ...(visible !== undefined && { visible }),
    });
    this.reportLayers();
  }

  async removeLayer(index: number): Promise<void> {
    const { id } = this.layerAt(index);
    if (this.layers.length === 1) return this.clear();
    if (this.lost) return;
    this.engine.call('remove_layer', id);
    this.report();
  }

  async moveLayer(from: number, to: number): Promise<void> {
    const { id } = this.layerAt(from);
    this.layerAt(to);
    if (this.lost) return;
    this.engine.call('move_layer', [id, to]);
    this.report();
  }

  // -- steps ------------------------------------------------------------------------------------

  get steps(): Steps { return this.engine.call<Steps>('steps'); }
  get holding(): boolean { return this.holding_; }
  set holding(held: boolean) {
    if (held !== this.holding_) this.engine.call('hold', held);
    this.holding_ = held;
  }
  undo(options: Cancelling = {}): Promise<void> { return this.step((position) => position - 1, options); }
  redo(options: Cancelling = {}): Promise<void> { return this.step((position) => position + 1, options); }
  goToStep(position: number, options: Cancelling = {}): Promise<void> {
    if (Number.isInteger(position) && position >= 0 && position <= this.steps.names.length) return this.step(() => position, options);
    throw new ViewerError(`There is no step ${position}: there are ${this.steps.names.length}.`, 'usage');
  }
  forgetSteps(): void {
    this.engine.call('forget_steps');
    this.reportStep();
  }

  private step(target: (position: number) => number, options: Cancelling): Promise<void> {
    return this.inTurn(options, async () => {
      const { names, position } = this.steps, wanted = target(position);
      if (wanted === position || wanted < 0 || wanted > names.length) return;
      this.requireDevice();
      const go = () => this.engine.call<number[]>('go_to', wanted), missing = go();
      if (missing.length > 0)
        await this.inColors(() => this.uploadFor(missing, options.signal, () => {
          if (this.steps.position !== position || go().length > 0) throw cancelled();  // another step was made meanwhile
        }));
      this.moved = true;  // the up axis may have changed
      this.report();
    });
  }

  /** Reads the layers again that the device lacks for a step, and goes to it. */
  private async uploadFor(missing: readonly number[], signal: AbortSignal | undefined, go: () => void): Promise<void> {
    try {
      for (const [part, ids] of this.byPart(missing)) await this.uploadAgain(part, ids, signal);
      go();
    } catch (error) {
      this.engine.call('drop_uploaded');
      throw error;
    }
  }

  /** Runs an upload of layers, which needs the colours, and returns to the debug view. */
  private async inColors<T>(change: () => T | Promise<T>): Promise<T> {
    const { name, features } = this.debugView_, { cancellations } = this;
    if (name === 'color') return change();
    await this.showNow('color', features);
    try {
      return await change();
    } finally {
      if (this.shown && !this.lost && this.cancellations === cancellations)
        await this.showNow(name, features).catch((error: unknown) => {
          if (!isCancelled(error)) this.emit('notice', reason(error));
        });
    }
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
    this.stop();
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
    if (found) {
      this.stop();  // a tour would move the view away again
      this.moved = true;
    }
    this.ask();
    return found;
  }
  frame(): void { this.moveTo('frame'); }
  home(): void {
    this.moveTo('home');
    this.reportStep();
  }
  showNamedView(view: NamedView, options: { readonly glide?: boolean } = {}): void {
    this.moveTo('named_view', view);
    if (options.glide === false) this.change('arrive', null);
  }
  showCamera(index: number): void { this.move('camera', index); }
  setUp(axis: Vec3): void {
    this.move('up', axis);
    this.reportStep();
  }
  getView(): ViewPose { return this.engine.call<ViewPose>('pose'); }
  setView(pose: ViewPose, options: { readonly glide?: boolean } = {}): void {
    this.move('set_pose', { pose, glide: options.glide ?? false });
  }
  play(tour: Tour, seconds?: number): void {
    if (tour !== 'turntable' && tour !== 'cameras') throw new ViewerError(`“${String(tour)}” is no tour: use turntable or cameras.`, 'usage');
    if (seconds !== undefined && !(seconds > 0 && seconds < Infinity)) throw new ViewerError('A tour needs seconds above 0.', 'usage');
    this.change('play', { what: tour, seconds: seconds ?? null });
    this.playing_ = tour;
    this.emit('tour', tour);
  }
  stop(): void {
    if (this.playing_ === null) return;
    this.change('play', null);
    this.endTour();
  }
  private endTour(): void {
    if (this.playing_ === null) return;
    this.playing_ = null;
    this.moved = true;
    this.emit('tour', null);
  }
  get playing(): Tour | null { return this.playing_; }

  get fov(): number { return this.getView().fov; }
  set fov(fov: number) { this.move('fov', fov); }
  get gliding(): boolean { return this.gliding_; }
  set gliding(gliding: boolean) { this.gliding_ = gliding; this.change('gliding', gliding); }

  // -- drawing ----------------------------------------------------------------------------------

  get background(): Vec3 { return this.engine.call<Vec3>('background'); }
  set background(color: Vec3) {
    this.engine.call('set_background', color);
    this.reportStep();
  }

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
      if (this.opening?.generation !== this.generation)
        this.opening = { generation: this.generation, done: this.readForDebugViews() };
      const opening = this.opening!;
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

  /** Reads all sources again: the renderer holds too little data for debug views. load(), clear() and dispose() cancel it. */
  private async readForDebugViews(): Promise<void> {
    const { generation } = this, parts = this.parts(), { signal } = this.rereading = new AbortController();
    const requireScene = () => {
      if (this.generation !== generation) throw new ViewerError('Another scene is open now.', 'cancelled');
      if (signal.aborted) throw cancelled();
    };
    if (parts.length === 0) throw new ViewerError('There is no scene for a debug view: open one first.', 'usage');
    for (const [number, { source, description: { name, further }, level }] of parts.entries()) {
      const files = further ? await this.asGlb(source, signal) :
        'url' in source ? oneFile(name, await download(urlOf(source), requireScene)) : await openFiles(source.files, source.name ?? name);
      requireScene();
      const splats = this.maxSplats.get(source);
      readWith(this.engine, 'read_for_debug_views', files,
               { source: number, ...(level !== null && { level }), ...(splats !== undefined && { max_splats: splats }) });
    }
    this.engine.call('keep_read_layers', [...this.origins].filter(([, { part }]) => parts.includes(part))
      .map(([id, { part, index }]) => [parts.indexOf(part), index, id]));
  }

  /** A source that only the program with all formats reads, in a format of this one. */
  private async asGlb(source: SceneSource, signal: AbortSignal): Promise<OpenedFiles> {
    const { file } = await writeFile(this.assets, { sources: [this.toWrite(source)], document: null, file: 'scene.glb' }, [signal], () => {});
    return oneFile('scene.glb', new Uint8Array(await file.arrayBuffer()));
  }

  private toWrite(source: SceneSource) {
    return { source: sourceToLoad(source), memory: this.options.memory, maxSplats: this.maxSplats.get(source) ?? null };
  }

  async write(format: WrittenFormat, { signal }: Cancelling = {}): Promise<WrittenScene> {
    const { shown, layers } = this, parts = this.parts();
    if (!shown) throw new ViewerError('There is no scene to write: open one first.', 'usage');
    if (!writtenFormats.includes(format)) throw new ViewerError(`“${String(format)}” is not written: use ${writtenFormats.join(', ')}.`, 'usage');
    const isPage = format === 'html', { width, height } = this.canvas;
    const written = await writeFile(this.assets, {
      sources: parts.map(({ source }) => this.toWrite(source)), file: `scene.${isPage ? 'glb' : format}`,
      document: {
        layers: layers.map(({ id, sourceLayer, name, transform, visible }) =>
          ({ source: parts.indexOf(this.origins.get(id)!.part), index: sourceLayer, name, transform, visible })),
        up: this.getView().up, background: this.background, view: isPage ? this.engine.call('shown_camera', [width, height]) : null,
      },
    }, [this.ending.signal, ...(signal ? [signal] : [])], (progress) => this.emit('progress', progress));
    return isPage ? { ...written, file: await pageWith(this.assets, written.file, shown.name) } : written;
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
    if (next !== 2) this.endTour();
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
    this.rereading.abort();
    this.detach?.();
    this.observer.disconnect();
    this.loading?.cancel();
    this.expected?.loading.cancel();
    this.sorting?.end();
    cancelAnimationFrame(this.frameAsked);
    if (!this.lost) this.engine.call('clear');
  }
}
