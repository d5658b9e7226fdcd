// One load under way: the worker that does it, and what it says.

import type { Assets } from './assets.js';
import type { FromLoader, PreparedScene, SourceToLoad, ToLoader } from './loader_messages.js';
import { ViewerError, type LoadProgress, type SceneSource } from './types.js';

const cancelled = () => new ViewerError('Loading was cancelled.', 'cancelled');

export interface LoadingEvents {
  progress(progress: LoadProgress): void;
  preview(scene: PreparedScene): void;
  /** Puts the scene on the device; false asks for it with a lower lattice level. */
  scene(scene: PreparedScene): boolean;
}

function sourceToLoad(source: SceneSource): SourceToLoad {
  if ('url' in source) {
    const url = new URL(source.url, document.baseURI).href;
    const file = decodeURIComponent(new URL(url).pathname.split('/').pop() ?? '');
    return { url, name: source.name || file || 'scene' };
  }
  if (source.files.length === 0) throw new ViewerError('There is no file to open.', 'usage');
  const files = source.files.map(({ path, data }) => ({ path: path.replace(/^\/+/, ''), data }));
  if (files.some(({ path }) => path === '' || path.split('/').includes('..')))
    throw new ViewerError('A file of the scene has no name within its folder.', 'usage');
  return { files, name: source.name || files[0]!.path };
}

export class Loading {
  private end: ((error: ViewerError | null) => void) | null = null;

  constructor(private readonly assets: Assets, private readonly events: LoadingEvents) {}

  /** Resolves when the scene is shown. Rejects with ViewerError. */
  async run(program: WebAssembly.Module, source: SceneSource, limits: unknown): Promise<void> {
    const toLoad = sourceToLoad(source);
    let worker: Worker | null = null;
    try {
      await new Promise<void>((resolve, reject) => {
        this.end = (error) => { if (error) reject(error); else resolve(); };
        void this.assets.loaderWorker().then((started) => {
          worker = started;
          if (!this.end) return started.terminate();  // cancelled meanwhile
          started.onerror = (event) => {
            event.preventDefault();
            this.end?.(new ViewerError(`The loader cannot run: ${event.message || 'its script is not whole'}.`, 'device'));
          };
          started.onmessage = ({ data }: MessageEvent<FromLoader>) => this.hear(data, started);
          started.postMessage({ kind: 'load', program, source: toLoad, limits } satisfies ToLoader);
        }, reject);
      });
    } finally {
      this.end = null;
      (worker as Worker | null)?.terminate();
    }
  }

  cancel(): void { this.end?.(cancelled()); }

  private hear(message: FromLoader, worker: Worker): void {
    if (!this.end) return;
    try {
      switch (message.kind) {
        case 'progress': return this.events.progress(message.progress);
        case 'preview': return this.events.preview(message.scene);
        case 'error': return this.end(new ViewerError(message.error.message, message.error.kind));
        case 'scene':
          if (this.events.scene(message.scene)) this.end(null);
          else worker.postMessage({ kind: 'lower' } satisfies ToLoader);
      }
    } catch (error) {
      this.end(error instanceof ViewerError ? error : new ViewerError(String(error), 'device'));
    }
  }
}
