// The worker that sorts splats while frames are drawn. It starts with the first task: scenes with few splats have
// none.

import type { Engine } from './engine.js';
import type { FromLoader, SortTask, ToLoader } from './loader_messages.js';
import type { Assets } from './types.js';

export class SplatSorting {
  private worker: Promise<Worker> | null = null;
  private failed = false;

  /** `changed`: the next frame has another order. */
  constructor(private readonly assets: Assets, private readonly program: Promise<WebAssembly.Module>,
              private readonly engine: Engine, private readonly changed: () => void) {}

  /** Sends the engine's task to the worker, if there is one. */
  async send(): Promise<void> {
    try {
      const task = this.engine.call<SortTask | null>('sort_task');
      if (!task) return;
      if (this.failed) return this.fail();
      const centers = this.engine.buffer().slice();
      const worker = await (this.worker ??= this.start());
      const message: ToLoader = { kind: 'sort', program: await this.program, task, centers };
      worker.postMessage(message, [centers.buffer]);
    } catch {
      this.fail();
    }
  }

  end(): void { this.worker?.then((worker) => worker.terminate(), () => {}); }

  private async start(): Promise<Worker> {
    const worker = await this.assets.loaderWorker();
    worker.onerror = () => this.fail();
    worker.onmessage = ({ data }: MessageEvent<FromLoader>) => {
      if (data.kind !== 'sorted') return this.fail();
      this.engine.setBuffer(data.order);
      if (this.engine.call<boolean>('sorted', data.number)) this.changed();
    };
    return worker;
  }

  /** From now on, the engine sorts in its frames, until it shows another scene. */
  private fail(): void {
    this.failed = true;
    this.engine.call('sort_in_frames');
    this.changed();
  }
}
