// One running load: its worker and the worker's messages.

import { fileNameOf, urlOf } from './addresses.js';
import { compile } from './engine.js';
import { needsFurther } from './formats.js';
import type { Block, FromLoader, LoadRole, PreparedLayer, PreparedScene, SourceToLoad, Taken, ToLoader } from './loader_messages.js';
import { ViewerError, type Assets, type LoadProgress, type SceneSource, type SplatOffer, type Vec3 } from './types.js';

interface CommonEvents {
  progress(progress: LoadProgress): void;
  /** Resolves to the number of splats to read. */
  offer(offer: SplatOffer, signal: AbortSignal): Promise<number>;
  /** Begins a large scene or layer; its blocks follow. */
  head(head: ArrayBuffer): void;
  block(block: Block): Taken;
}

export interface LoadingEvents extends CommonEvents {
  preview(scene: PreparedScene): void;
  /** Uploads the scene to the device. Returns null, or the reason if the device's memory is too small; the
   *  scene then arrives again with a lower lattice level. */
  scene(scene: PreparedScene): string | null;
}

/** The events of a load that adds layers: no preview, and layer after layer instead of a scene. */
export interface AddingEvents extends CommonEvents {
  layer(layer: PreparedLayer): void;
}

/** Throws ViewerError. */
export function sourceToLoad(source: SceneSource): SourceToLoad {
  const detail = source.lod === undefined ? {} : { lod: source.lod };
  if ('url' in source) {
    const url = urlOf(source);
    return { url, name: source.name || fileNameOf(url) || 'scene', ...detail };
  }
  if (source.files.length === 0) throw new ViewerError('The scene has no files.', 'usage');
  const files = source.files.map(({ path, data }) => ({ path: path.replace(/^\/+/, ''), data }));
  if (files.some(({ path }) => path === '' || path.split('/').includes('..')))
    throw new ViewerError('A file of the scene has no valid path within its folder.', 'usage');
  return { files, name: source.name || files[0]!.path, ...detail };
}

/** Whether the names of its files need the program with all formats. */
const isFurther = (source: SourceToLoad) =>
  'url' in source ? needsFurther(fileNameOf(source.url)) : source.files.some(({ path }) => needsFurther(path));

/** Whether the memory was too small; a lower lattice level may then fit. */
export const isShortage = (error: unknown): error is ViewerError => error instanceof ViewerError && error.kind === 'memory';

/** Begins in the constructor with the work that needs no graphics device. Its messages wait for run(). */
export class Loading {
  private readonly shown: Promise<void>;
  private settle!: { resolve(): void; reject(why: unknown): void };
  private events: LoadingEvents | AddingEvents | null = null;
  private worker: Worker | null = null;
  private readonly unheard: FromLoader[] = [];
  private readonly ending = new AbortController();
  /** Begins again in the program with all formats. */
  private restart: (downloaded: Blob | null) => void = () => {};

  /** `limits`: limits of the device; preparing waits for them. `memory`, `maxSplats`: as in LoadMessage. `role` decides
   *  which events run() needs. */
  constructor(assets: Assets, program: Promise<WebAssembly.Module>, limits: Promise<unknown>, source: SceneSource,
              private readonly memory: number, private readonly maxSplats: number | null,
              private readonly role: LoadRole = 'scene', private readonly up: Vec3 | null = null) {
    this.shown = new Promise((resolve, reject) => { this.settle = { resolve, reject }; });
    this.shown.catch(() => {});  // run() returns the error
    limits.catch(() => {});  // begin() awaits it later, after the worker
    this.begin(assets, program, limits, source).catch((error: unknown) => this.end(error));
  }

  /** Resolves when the scene is shown. Rejects with ViewerError. Call it only once. */
  run(events: LoadingEvents | AddingEvents): Promise<void> {
    this.events = events;
    for (const message of this.unheard) this.hear(message);
    return this.shown;
  }

  cancel(why = new ViewerError('Loading was cancelled.', 'cancelled')): void { this.end(why); }

  private async begin(assets: Assets, program: Promise<WebAssembly.Module>, limits: Promise<unknown>,
                      source: SceneSource): Promise<void> {
    const toLoad = sourceToLoad(source), { further } = assets;
    this.restart = (downloaded) => {
      this.worker!.terminate();
      const { name, lod } = toLoad;
      const again = downloaded ? { files: [{ path: name, data: downloaded }], name, ...(lod !== undefined && { lod }) } : toLoad;
      this.beginIn(further!, compile(further!), limits, again, 'further').catch((error: unknown) => this.end(error));
    };
    if (further && isFurther(toLoad)) return this.beginIn(further, compile(further), limits, toLoad, 'further');
    return this.beginIn(assets, program, limits, toLoad, further ? 'first' : 'only');
  }

  private async beginIn(assets: Pick<Assets, 'loaderWorker'>, program: Promise<WebAssembly.Module>, limits: Promise<unknown>,
                        source: SourceToLoad, which: 'first' | 'only' | 'further'): Promise<void> {
    program.catch(() => {});  // awaited after the worker
    const worker = this.worker = await assets.loaderWorker();
    if (this.over) return worker.terminate();  // cancelled in the meantime
    const tell = (message: ToLoader) => worker.postMessage(message);
    worker.onerror = (event) => {
      event.preventDefault();
      this.end(new ViewerError(`The loader cannot run: ${event.message || 'its script is incomplete'}.`, 'device'));
    };
    worker.onmessage = ({ data }: MessageEvent<FromLoader>) => {
      if (this.events) this.hear(data);
      else this.unheard.push(data);
    };
    const { role, memory, maxSplats, up } = this;
    tell({ kind: 'load', source, role, memory, maxSplats, up, program: which });
    tell({ kind: 'program', program: await program });
    tell({ kind: 'limits', limits: await limits });
  }

  private end(error: unknown = null): void {
    if (this.over) return;
    this.ending.abort();
    this.worker?.terminate();
    if (error === null) this.settle.resolve();
    else this.settle.reject(error);
  }

  private get over(): boolean { return this.ending.signal.aborted; }

  private async answer(offer: SplatOffer): Promise<void> {
    try {
      const number = await this.events!.offer(offer, this.ending.signal);
      this.worker!.postMessage({ kind: 'splats', number } satisfies ToLoader);
    } catch (error) {
      this.end(error instanceof ViewerError ? error : new ViewerError(String(error), 'cancelled'));
    }
  }

  private hear(message: FromLoader): void {
    if (this.over) return;
    const events = this.events!;
    try {
      switch (message.kind) {
        case 'progress': return events.progress(message.progress);
        case 'preview': return (events as LoadingEvents).preview(message.scene);
        case 'head': return events.head(message.head);
        case 'block': {
          const { block } = message, taken = events.block(block);
          const bytes = taken === 'kept' ? new ArrayBuffer() : block.bytes;
          return this.worker!.postMessage({ kind: 'taken', taken, bytes } satisfies ToLoader, [bytes]);
        }
        case 'elsewhere': return this.restart(message.downloaded);
        case 'offer': return void this.answer(message.offer);
        case 'error': return this.end(new ViewerError(message.error.message, message.error.kind));
        case 'scene': {
          const why = (events as LoadingEvents).scene(message.scene);
          if (why === null) this.end();
          else this.worker!.postMessage({ kind: 'lower', why } satisfies ToLoader);
          return;
        }
        case 'layer': {
          const { layer } = message;
          (events as AddingEvents).layer(layer);
          if (layer.left === 0) this.end();
          else this.worker!.postMessage({ kind: 'next' } satisfies ToLoader);
        }
      }
    } catch (error) {
      this.end(error instanceof ViewerError ? error : new ViewerError(String(error), 'device'));
    }
  }
}
