// The script of all workers. A worker sorts splats (splat_sorting.ts), inflates for another one (inflating.ts), writes a file
// (writing.ts), or loads one scene: it fetches and reads the scene, prepares the device's data and transfers them. The end
// of the worker frees all its memory, so a load is cancelled by ending it.

import { fileNameOf } from './addresses.js';
import { download } from './download.js';
import { EarlyTexels } from './early_texels.js';
import { Engine, type Parcel } from './engine.js';
import { planFiles, type PlannedFiles } from './file_plan.js';
import { namesOthers } from './formats.js';
import { inflate } from './inflating.js';
import type {
  Deflated, FilesToLoad, FromLoader, LoadMessage, PreparedScene, SceneDescription, SortMessage, SourceToLoad, ToLoader, WriteMessage,
} from './loader_messages.js';
import { Preview } from './preview.js';
import { oneFile, openFiles, readWith, type OpenedFiles } from './scene_files.js';
import { Sending, type BlobSize, type Prepared } from './sending.js';
import { ViewerError, type LoadStage, type SplatOffer } from './types.js';

type Stage = Exclude<LoadStage, 'write'>;
/** Fraction on the progress bar at the start of each stage, for local files and for downloads. */
const starts: Record<'files' | 'url', Record<Stage, number>> = {
  files: { download: 0, read: 0, prepare: 0.8, upload: 0.95 },
  url: { download: 0, read: 0.6, prepare: 0.9, upload: 0.97 },
};
/** Part of the time for reading that is spent on decoding texels early, if there are any. An estimate. */
const decodingPart = 0.8;
const order: readonly Stage[] = ['download', 'read', 'prepare', 'upload'];

/** The file at an address; one that names others has its folder in its path. */
function fileAt(url: string, name: string, bytes: Uint8Array<ArrayBuffer>): OpenedFiles {
  const [folder, file] = url.replace(/[?#].*$/s, '').split('/').slice(-2).map(fileNameOf);
  if (!folder || !file || !namesOthers(file)) return oneFile(name, bytes);
  const path = `${folder}/${file}`;
  return { bytes: new Map([[path, bytes]]), paths: [path] };
}

/** The bytes of several downloads. */
class Downloads {
  loaded = 0;
  total: number | null = 0;
  constructor(private readonly arrived: () => void) {}
  async part(url: string): Promise<Uint8Array<ArrayBuffer>> {
    let known: number | null | undefined, before = 0;
    return download(url, ({ bytes, total }) => {
      if (known === undefined) this.total = total === null || this.total === null ? null : this.total + total;
      known = total;
      this.loaded += bytes.length - before;
      before = bytes.length;
      this.arrived();
    });
  }
}

class Loader {
  private description: SceneDescription | null = null;
  private level: number | null = null;
  private readMs = 0;
  private planMs = 0;
  private readFrom = 0;
  private loaded = 0;
  private total: number | null = null;
  private told = { stage: '', permille: -1 };
  private wanted: readonly { readonly index: number; readonly forecast: number }[] = [];  // layers
  private nextLayer = 0;
  readonly sending = new Sending(() => this.engine, post);

  private readonly from: 'files' | 'url';

  private started: Engine | null = null;
  private knowsLimits = false;
  private preview: Preview | null = null;
  /** The bytes so far, until a reader has all. */
  private prefix: Uint8Array<ArrayBuffer> | null = null;
  private readonly early = new EarlyTexels(() => this.engine);

  constructor(private readonly starting: Promise<Engine>, private readonly limits: Promise<unknown>,
              private readonly chosen: Promise<number>, private readonly message: LoadMessage) {
    this.from = 'url' in message.source ? 'url' : 'files';
    starting.then((engine) => { this.started = engine; }, () => {});  // load() reports the error
    limits.then(() => { this.knowsLimits = true; }, () => {});
    Promise.all([starting, limits]).then(() => this.use()).catch(() => {});
  }

  async load(): Promise<void> {
    const { source } = this.message;
    const [found] = await Promise.all([
      'url' in source ? this.fetched(source.url, source.name) : this.opened(source),
      this.starting,
    ]);
    const planned = this.message.program === 'further' ? await this.planned(found) : { files: found, given: {}, levels: [] };
    const { files } = planned;
    const begin = performance.now(), [only, ...others] = files.bytes.values();
    if (only && others.length === 0) await this.decodeTexels(only);
    this.engine.onProgress = (fraction) => this.tell('read', this.readFrom + (1 - this.readFrom) * fraction);
    const description = await this.read(planned);
    if (!description) return post({ kind: 'elsewhere', downloaded: this.from === 'url' && only ? new Blob([only]) : null });
    this.description = { ...description, levels: planned.levels, lod: planned.given.lod ?? 0, further: this.message.program === 'further' };
    this.readMs = performance.now() - begin;
    const { role } = this.message;
    if (role === 'scene') return this.send();
    this.level = role.level;
    const forecasts = this.engine.call<number[]>('forecast', { limits: await this.limits });
    this.wanted = (role.indices ?? [...forecasts.keys()]).map((index) => {
      const forecast = forecasts[index];
      if (forecast === undefined) throw new ViewerError(`${source.name} has changed: it has no layer ${index + 1} any more.`, 'input');
      return { index, forecast };
    });
    await this.sendLayer();
  }

  /** After it has started. */
  private get engine(): Engine { return this.started!; }

  /** Reads the scene, or a part of its splats if the memory does not hold all. */
  private async read({ files, given }: PlannedFiles): Promise<SceneDescription | null> {
    const { memory, maxSplats, up } = this.message;
    const elsewhere = this.message.program === 'first';
    const once = (splats: number | null) => readWith<SceneDescription | { readonly offer: SplatOffer } | null>(
      this.engine, 'read', files, { ...given, elsewhere, ...(up && { up }), ...(splats === null ? { memory } : { max_splats: splats }) });
    const result = once(maxSplats);
    if (!result || !('offer' in result)) return result;
    post({ kind: 'offer', offer: { ...result.offer, name: this.message.source.name, memory } });
    return once(await this.chosen) as SceneDescription;
  }

  /** Sends the next layer. */
  async sendLayer(): Promise<void> {
    const number = this.nextLayer++, count = this.wanted.length, { index, forecast } = this.wanted[number]!;
    this.engine.onProgress = (fraction) => this.tell('prepare', (number + fraction) / count);
    const prepared = this.prepare(await this.limits, index);
    this.tell('upload', number / count);
    const parcel = await this.sending.send(prepared);
    post({ kind: 'layer', layer: { description: this.description!, parcel, index, forecast, count, left: count - number - 1 } });
  }

  /** Sends the scene again with the next lower lattice level. `why`: the device's message. */
  async lower(why: string): Promise<void> {
    const level = this.level ?? this.engine.call<number | null>('lattice_level');
    if (!level)
      throw new ViewerError(`This device has not enough memory for the scene${level === 0 ? ', even at lattice level 0' : ''}: ${why}`,
                            'memory');
    this.level = level - 1;
    await this.send();
  }

  private async fetched(url: string, name: string): Promise<OpenedFiles> {
    // Added layers have no preview: the scene stays visible.
    if (this.message.role === 'scene')
      this.preview = new Preview(() => this.engine, name, this.message.memory, performance.now());
    const bytes = await download(url, async ({ bytes: prefix, total }) => {
      this.loaded = prefix.length;
      this.total = total;
      this.tell('download', total === null ? null : prefix.length / total);
      this.prefix = prefix.length === total ? null : prefix;
      if (this.started) await this.use();
    });
    this.prefix = null;
    return fileAt(url, name, bytes);
  }

  /** With the files that the scene names. */
  private async planned(files: OpenedFiles): Promise<PlannedFiles> {
    const { source, memory, maxSplats } = this.message;
    const downloads = new Downloads(() => {
      const { loaded, total } = downloads;
      this.loaded = loaded;
      this.total = total;
      this.tell('download', total ? loaded / total : null);
    });
    return planFiles(this.engine, files, source, memory, maxSplats, (url) => downloads.part(url));
  }

  /** Uses the first bytes of a download: after each arrival, and when engine and device are ready. */
  private async use(): Promise<void> {
    const { prefix, total } = this;
    if (!prefix || !this.preview) return;
    await this.showPreview(prefix, total);
    this.early.begin(prefix, this.preview.knowsHeader);
    this.early.feed(prefix);
  }

  private async showPreview(prefix: Uint8Array, total: number | null): Promise<void> {
    const { preview } = this, begin = performance.now();
    const description = preview && this.knowsLimits ? preview.read(prefix, total) : null;
    if (!description) return;
    try {
      post({ kind: 'preview', scene: await this.preparedPreview(description) });
    } catch {
      return preview!.stop();  // the memory may hold the scene without it
    }
    preview!.took(performance.now() - begin);
  }

  /** Decodes the texels that are left. */
  private async decodeTexels(bytes: Uint8Array<ArrayBuffer>): Promise<void> {
    this.prefix = bytes;  // for a preview
    await this.early.finish(bytes, (fraction) => {
      this.tell('read', decodingPart * fraction);
      this.readFrom = decodingPart;
    });
    this.prefix = null;
    if (this.readFrom === 0) return;
    await this.limits;  // the device may start only now: a preview is still earlier than the scene
    await this.showPreview(bytes, bytes.length);
  }

  private async opened({ files, name }: FilesToLoad): Promise<OpenedFiles> {
    this.loaded = this.total = files.reduce((sum, { data }) => sum + data.size, 0);
    return openFiles(files, name);
  }

  private async send(): Promise<void> {
    this.engine.onProgress = (fraction) => this.tell('prepare', fraction);
    const parcel = await this.sending.send(this.prepare(await this.limits));
    this.tell('upload', 0);
    post({ kind: 'scene', scene: this.prepared(this.description!, parcel) });
  }

  private async preparedPreview(description: SceneDescription): Promise<PreparedScene> {
    return this.prepared(description, this.sending.parcel(this.prepare(await this.limits)));
  }

  private prepared(description: SceneDescription, parcel: Parcel): PreparedScene {
    const { level, readMs, planMs } = this;
    return { description, parcel, level, decoded: this.early.decoded, readMs, planMs };
  }

  /** Prepares the scene, or a layer. */
  private prepare(limits: unknown, layer: number | null = null): Prepared {
    const level = this.level === null ? {} : { level: this.level }, only = layer === null ? {} : { layer };
    const begin = performance.now(), blobs = this.engine.call<BlobSize[]>('prepare', { limits, ...level, ...only });
    this.planMs = performance.now() - begin;
    return { head: this.engine.buffer().slice().buffer, blobs };
  }

  /** Reports progress, but only after a change of 0.1 % or 100 kB. */
  private tell(stage: Stage, part: number | null): void {
    const begin = starts[this.from], next = order[order.indexOf(stage) + 1];
    const fraction = part === null ? null : begin[stage] + part * ((next ? begin[next] : 1) - begin[stage]);
    const permille = fraction === null ? Math.floor(this.loaded / 1e5) : Math.floor(1000 * fraction);
    if (this.told.stage === stage && this.told.permille === permille) return;
    this.told = { stage, permille };
    const left = this.wanted.slice(Math.max(this.nextLayer - 1, 0));
    const deviceBytes = left.length ? left.reduce((sum, { forecast }) => sum + forecast, 0) : null;
    post({ kind: 'progress', progress: { stage, fraction, loadedBytes: this.loaded, totalBytes: this.total, deviceBytes } });
  }
}

/** The memory that goes to the page with a message. */
function transferred(message: FromLoader): Transferable[] {
  switch (message.kind) {
    case 'scene':
    case 'preview': return [message.scene.parcel.head, ...message.scene.parcel.blobs];
    case 'layer': return [message.layer.parcel.head, ...message.layer.parcel.blobs];
    case 'head': return [message.head];
    case 'block': return [message.block.bytes];
    case 'sorted': return [message.order.buffer];
    case 'written': return [message.bytes.buffer];
    case 'inflated': return message.inflated.map(({ buffer }) => buffer);
    default: return [];
  }
}

function post(message: FromLoader): void { self.postMessage(message, { transfer: transferred(message) }); }

async function opened(source: SourceToLoad): Promise<OpenedFiles> {
  return 'url' in source ? fileAt(source.url, source.name, await download(source.url, () => {})) : openFiles(source.files, source.name);
}

async function write({ sources, document, file }: WriteMessage): Promise<void> {
  const engine = await Engine.create(await program), count = sources.length + 1;
  const tell = (stage: LoadStage, part: number) =>
    post({ kind: 'progress', progress: { stage, fraction: part / count, loadedBytes: 0, totalBytes: null, deviceBytes: null } });
  for (const [number, { source, memory, maxSplats }] of sources.entries()) {
    tell('read', number);
    const { files, given } = await planFiles(engine, await opened(source), source, memory, maxSplats, (url) => download(url, () => {}));
    readWith(engine, 'read_for_debug_views', files, { ...given, source: number, ...(maxSplats !== null && { max_splats: maxSplats }) });
  }
  engine.onProgress = (fraction) => tell('write', sources.length + fraction);
  tell('write', sources.length);
  const path = `/written/${file}`, losses = engine.call<string[]>('write', { file: path, document });
  post({ kind: 'written', bytes: engine.takeFile(path), losses });
}

let sorter: Promise<Engine> | null = null;

async function sortSplats({ program, task, centers }: SortMessage): Promise<void> {
  const engine = await (sorter ??= Engine.create(program));
  engine.setBuffer(centers);
  engine.call('sort', task);
  post({ kind: 'sorted', number: task.number, order: engine.buffer().slice() });
}

let inflated: Promise<unknown> = Promise.resolve();

/** Answers in the order of the messages. */
async function inflateInOrder(streams: readonly Deflated[]): Promise<void> {
  const mine = inflated.then(() => inflate(streams));
  inflated = mine.catch(() => {});
  post({ kind: 'inflated', inflated: await mine });
}

let loader: Loader | null = null;
let giveProgram: (program: WebAssembly.Module) => void;
const program = new Promise<WebAssembly.Module>((resolve) => { giveProgram = resolve; });
let giveLimits: (limits: unknown) => void;
const limits = new Promise<unknown>((resolve) => { giveLimits = resolve; });
let choose: (splats: number) => void;
const chosen = new Promise<number>((resolve) => { choose = resolve; });

async function handle(message: ToLoader): Promise<void> {
  switch (message.kind) {
    case 'load':
      loader = new Loader(program.then((compiled) => Engine.create(compiled)), limits, chosen, message);
      return loader.load();
    case 'program': return giveProgram(message.program);
    case 'limits': return giveLimits(message.limits);
    case 'splats': return choose(message.number);
    case 'lower': return loader!.lower(message.why);
    case 'next': return loader!.sendLayer();
    case 'taken': return loader!.sending.taken(message.taken, message.bytes);
    case 'sort': return sortSplats(message);
    case 'write': return write(message);
    case 'inflate': return inflateInOrder(message.streams);
  }
}

self.onmessage = ({ data }: MessageEvent<ToLoader>) => {
  handle(data).catch((error: unknown) => {
    const known = error instanceof ViewerError;
    post({ kind: 'error', error: { kind: known ? error.kind : 'device',
                                   message: known ? error.message : `The loader failed: ${String(error)}` } });
  });
};
