// An engine for measurements: several scenes on one canvas, and frames timed by the protocol of
// `tureen bench` (web/engine/bench.cpp). It draws with the viewer's pipeline.

import { ArrivingScene } from '../viewer/arriving_scene.js';
import { assetsAt } from '../viewer/assets.js';
import { compile, Engine } from '../viewer/engine.js';
import type { FilesToLoad, PreparedScene, SceneDescription } from '../viewer/loader_messages.js';
import { isShortage, Loading } from '../viewer/loading.js';
import { openFiles, readWith } from '../viewer/scene_files.js';
import { ViewerError, type Assets, type LoadProgress } from '../viewer/types.js';
import { setName, type CameraSet, type Size } from './request.js';

export interface Device {
  readonly renderer: string;
  readonly vendor: string;
  readonly gl_version: string;
  /** `software`: whether the processor draws. */
  readonly limits: { readonly software: boolean };
  readonly max_image_side: number;
}

/** Work that a plan omits: docs/json.md. */
export interface Specialisation {
  readonly name: string;
  readonly count: number;
  readonly total: number;
  readonly margin: number;
}

/** A scene drawn by one pipeline. */
export interface Pipeline {
  readonly plan: readonly string[];
  readonly specialisations: readonly Specialisation[];
  readonly plan_ms: number;
  readonly upload_ms: number;
  readonly device_bytes: number;
}

export interface AddedScene {
  readonly description: SceneDescription;
  readonly pipeline: Pipeline;
  readonly readMs: number;
  /** The reduced lattice level if the device has too little memory; otherwise null. */
  readonly level: number | null;
}

export type BenchCase =
  | { readonly name: string; readonly scene: number; readonly published: boolean }
  | { readonly name: string; readonly grid: readonly number[] };

/** Milliseconds per frame, [round][view]; all rounds have the same views in the same order. */
export type FrameTimes = readonly (readonly number[])[];

/** In milliseconds, except ratios and rates: jobs/timing/frame_statistics.hpp. */
export interface Statistics {
  readonly mean: number;
  readonly median: number;
  readonly p95: number;
  readonly p99: number;
  readonly min_of_medians: number;
  readonly spread: number;
  readonly low_1_percent_fps: number;
}

export interface CaseResult {
  readonly name: string;
  readonly stable: boolean;
  readonly frame_ms: FrameTimes;
  readonly pixels_hash: string;
  readonly statistics: Statistics;
}

export interface RunResult {
  readonly frames_per_sample: number;
  /** Spread of the first case against itself: smaller differences are noise. */
  readonly aa_spread: number;
  readonly self_test_ms: readonly [FrameTimes, FrameTimes];
  readonly entrants: readonly CaseResult[];
}

/** A part of the canvas, in pixels from its bottom left corner. */
export interface Cell extends Size {
  readonly scene: number;
  readonly x: number;
  readonly y: number;
}

/** Time of one measuring step, between which the page handles events. Long enough for several samples
 *  on any device, and short enough for a responsive Cancel button. */
const stepMs = 50;

/** The engine that measures. The loader's workers run the page's engine. */
async function benchProgram(): Promise<ArrayBuffer> {
  const url = new URL('tureen_bench.wasm', import.meta.url), response = await fetch(url).catch(() => null);
  if (!response?.ok) throw new ViewerError(`A file of the benchmark cannot be loaded: ${url.href}.`, 'network');
  return response.arrayBuffer();
}

/** Waits for the browser's next frame, so it pauses while the page is hidden. */
const nextFrame = () => new Promise((resolve) => requestAnimationFrame(resolve));

const contextLost = () => new ViewerError(
  'The browser reset the graphics device. Probable causes are too little memory or a frame that took too long. ' +
  'Measure again with fewer scenes or a smaller image size.', 'device');

/** Rejects with the signal's reason. The caller may have stopped waiting by then. */
function aborted(signal: AbortSignal): Promise<never> {
  const ended = new Promise<never>((_, reject) => {
    if (signal.aborted) reject(signal.reason);
    else signal.addEventListener('abort', () => reject(signal.reason), { once: true });
  });
  ended.catch(() => {});
  return ended;
}

export class BenchEngine {
  private readonly lost = new AbortController();

  private constructor(private readonly engine: Engine, private readonly program: WebAssembly.Module,
                      private readonly assets: Assets, readonly canvas: HTMLCanvasElement, readonly device: Device) {
    canvas.addEventListener('webglcontextlost', (event) => {
      event.preventDefault();  // otherwise the browser does not restore the context
      this.lost.abort(contextLost());
    }, { signal: this.lost.signal });
  }

  /** Rejects with ViewerError. */
  static async start(canvas: HTMLCanvasElement): Promise<BenchEngine> {
    const assets = assetsAt();
    const [program, measuring] = await Promise.all([compile(assets), compile({ ...assets, wasm: benchProgram })]);
    const engine = await Engine.create(measuring);
    engine.takeCanvas(canvas);
    return new BenchEngine(engine, program, assets, canvas, engine.call<Device>('start'));
  }

  /** Whether the context is lost; a new engine is then needed. Commands may fail before the event. */
  get isLost(): boolean { return this.lost.signal.aborted || this.canvas.getContext('webgl2')!.isContextLost(); }
  get wasmBytes(): number { return this.engine.memoryBytes; }

  /** Removes all scenes. */
  clear(): void { this.engine.call('bench_clear'); }

  /** Adds a scene; its number is the previous count. Rejects with ViewerError or the signal's reason. */
  async add(files: FilesToLoad, signal: AbortSignal, tell: (progress: LoadProgress) => void): Promise<AddedScene> {
    let added: AddedScene | null = null, arriving: ArrivingScene | null = null, uploadMs = 0;
    const program = Promise.resolve(this.program), limits = Promise.resolve(this.device.limits);
    // A benchmark measures all splats.
    const loading = new Loading(this.assets, program, limits, files, Number.MAX_VALUE, null);
    const load = loading.run({
      progress: tell,
      offer: ({ splats }) => Promise.resolve(splats),
      preview: () => {},
      head: (head) => {
        arriving = new ArrivingScene(this.engine, head, null);
        uploadMs = 0;
      },
      block: (block) => {
        const begin = performance.now(), taken = arriving!.take(block);
        uploadMs += performance.now() - begin;
        return taken;
      },
      scene: (scene) => {
        try {
          const whole = arriving;
          arriving = null;
          whole?.finish();
          added = this.unpack(scene, uploadMs);
          return null;
        } catch (error) {
          if (isShortage(error) && !this.isLost) return error.message;
          throw error;
        }
      },
    });
    try {
      await Promise.race([load, aborted(signal), aborted(this.lost.signal)]);
    } finally {
      loading.cancel();
      load.catch(() => {});
      if (!this.isLost) (arriving as ArrivingScene | null)?.drop();
    }
    return added!;
  }

  /** `uploadMs`: time for the blocks before. */
  private unpack({ description, parcel, level, readMs, planMs }: PreparedScene, uploadMs: number): AddedScene {
    const facts = this.engine.give<Omit<Pipeline, 'plan_ms'>>(parcel, 'bench_add_scene', { scene: description });
    return { description, level, readMs, pipeline: { ...facts, plan_ms: planMs, upload_ms: facts.upload_ms + uploadMs } };
  }

  /** Prepares the same scene for the baseline. Rejects with ViewerError if the baseline cannot draw it. */
  async addPublished(scene: number, { files, name }: FilesToLoad): Promise<Pipeline> {
    return readWith<Pipeline>(this.engine, 'bench_add_published', await openFiles(files, name), { scene });
  }

  setCameras(scene: number, cameras: CameraSet, { width, height }: Size): void {
    this.engine.call('bench_cameras', { scene, set: setName(cameras), width, height });
  }

  /** Draws frames, with pauses only between steps. Rejects with ViewerError or the signal's reason. */
  async run(cases: readonly BenchCase[], how: { readonly rounds: number; readonly minSampleMs: number },
            signal: AbortSignal, tell: (fraction: number) => void): Promise<RunResult> {
    this.engine.call('bench_run', { entrants: cases, rounds: how.rounds, least_sample_ms: how.minSampleMs });
    for (let done = false; !done;) {
      await nextFrame();
      signal.throwIfAborted();
      const step = this.ask<{ done: boolean; fraction: number }>('bench_step', stepMs);
      tell(step.fraction);
      done = step.done;
    }
    return this.ask<RunResult>('bench_result');
  }

  /** Throws if the context is lost: a lost context draws nothing and reports wrong times. */
  private ask<T>(command: string, given: unknown = null): T {
    try {
      const answer = this.engine.call<T>(command, given);
      if (!this.isLost) return answer;
    } catch (error) {
      if (!this.isLost) throw error;
    }
    throw contextLost();
  }

  /** Draws the visible image; it is not timed. */
  show(cells: readonly Cell[], { width, height }: Size, camera: number): void {
    if (this.isLost) return;
    this.canvas.width = width;
    this.canvas.height = height;
    this.canvas.hidden = false;
    this.engine.call('bench_show', { cells: cells.map((cell) => ({ ...cell, camera })), width, height });
  }
}
