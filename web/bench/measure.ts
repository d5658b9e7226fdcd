// Runs a request, from the bytes of its scenes to frame times. It measures each scene at each size, one
// after the other, or all scenes on a grid in one frame.

import { nameOf, urlOf } from '../viewer/addresses.js';
import { download } from '../viewer/download.js';
import { lowerLevelSentence } from '../viewer/scene_summary.js';
import { ViewerError } from '../viewer/types.js';
import type { FilesToLoad } from '../viewer/loader_messages.js';
import type { AddedScene, BenchEngine, Cell, BenchCase, Pipeline, RunResult } from './bench_engine.js';
import { clockStepMs } from './clock.js';
import { setName, sizeText, type Address, type BenchRequest, type Size } from './request.js';

export interface Configuration extends Pipeline {
  readonly name: string;
}

/** One set of cameras at one size. */
export interface Measurement extends Size {
  readonly cameraSet: string;
  readonly result: RunResult;
}

/** The results of one scene, or of one grid of scenes. */
export interface MeasuredScene {
  readonly name: string;
  readonly source: string;
  readonly triangles: number;
  readonly appearance: string;
  readonly readMs: number;
  readonly wasmBytes: number;
  readonly configurations: readonly Configuration[];
  readonly measurements: readonly Measurement[];
  readonly notes: readonly string[];
}

/** Reports the current task and the completed fraction of the request, 0..1. */
export type Tell = (what: string, fraction: number) => void;

/** Assumed fraction of the time for loading, for the progress bar. */
const loadingShare = 0.1;

/** Minimum length of a sample: 100 clock steps, so that the clock's error is 1 %, and at least the 5 ms
 *  of `tureen bench`. */
export const minSampleMs = () => Math.max(5, 100 * clockStepMs());

/** Cells for `count` images in an image of this size, row by row from the top. A remainder stays empty. */
export function gridCells(count: number, size: Size): Cell[] {
  const columns = Math.ceil(Math.sqrt(count)), rows = Math.ceil(count / columns);
  const width = Math.max(Math.floor(size.width / columns), 1), height = Math.max(Math.floor(size.height / rows), 1);
  return Array.from({ length: count }, (_, scene) => ({
    scene, width, height,
    x: (scene % columns) * width,
    y: size.height - (Math.floor(scene / columns) + 1) * height,
  }));
}

const distinct = (texts: readonly string[]) => [...new Set(texts)];
const sum = (values: readonly number[]) => values.reduce((total, value) => total + value, 0);

export class Measuring {
  private readonly fetched = new Map<string, FilesToLoad>();

  constructor(private readonly bench: BenchEngine, private readonly request: BenchRequest,
              private readonly signal: AbortSignal, private readonly tell: Tell) {}

  /** Rejects with ViewerError and the signal's reason. */
  async run(): Promise<MeasuredScene[]> {
    const { scenes, grid, copies } = this.request;
    const frames = grid ? [scenes.flatMap((scene) => Array<Address>(copies).fill(scene))] : scenes.map((scene) => [scene]);
    const measured: MeasuredScene[] = [];
    for (const [index, sources] of frames.entries()) {
      const tell: Tell = (what, fraction) => this.tell(what, (index + fraction) / frames.length);
      measured.push(await this.measureFrame(sources, tell));
    }
    return measured;
  }

  /** Measures the scenes of one frame. */
  private async measureFrame(sources: readonly Address[], tell: Tell): Promise<MeasuredScene> {
    const { bench, request } = this;
    const hidden = new Hidden();
    bench.clear();
    const added: AddedScene[] = [];
    for (const source of sources) {
      const name = nameOf(source) + (sources.length > 1 ? `, ${added.length + 1} of ${sources.length}` : '');
      const load: Tell = (what, fraction) =>
        tell(`${name}: ${what}`, (loadingShare * (added.length + fraction)) / sources.length);
      const files = await this.files(source, load);
      load('reading', 0.5);
      added.push(await bench.add(files, this.signal, ({ fraction }) => load('reading', 0.5 + (fraction ?? 0) / 2)));
    }
    const configurations = [this.ours(added)], notes = this.notes(added);
    if (request.published) {
      tell(`${nameOf(sources[0]!)}: preparing the baseline`, loadingShare);
      try {
        const files = await this.files(sources[0]!, tell);
        configurations.push({ name: 'published', ...await bench.addPublished(0, files) });
      } catch (error) {
        if (!(error instanceof ViewerError) || bench.isLost) throw error;
        notes.push(`The baseline is missing: ${error.message}`);
      }
    }
    const measurements: Measurement[] = [];
    for (const [index, size] of request.sizes.entries())
      measurements.push(await this.measureAt(size, added, configurations, (what, fraction) =>
        tell(what, loadingShare + ((1 - loadingShare) * (index + fraction)) / request.sizes.length)));
    if (hidden.end())
      notes.push('The page was hidden during the measurement; browsers slow down hidden pages.');
    return {
      ...this.described(sources, added), wasmBytes: bench.wasmBytes, configurations, measurements, notes,
    };
  }

  private async files(source: Address, tell: Tell): Promise<FilesToLoad> {
    const name = nameOf(source), url = urlOf(source);
    let files = this.fetched.get(url);
    if (!files) {
      tell('downloading', 0);
      const bytes = await download(url, ({ bytes, total }) => {
        this.signal.throwIfAborted();
        tell('downloading', total ? bytes.length / total / 2 : 0);
      });
      files = { files: [{ path: name, data: new Blob([bytes]) }], name };
      this.fetched.set(url, files);
    }
    return files;
  }

  private ours(added: readonly AddedScene[]): Configuration {
    const pipelines = added.map(({ pipeline }) => pipeline);
    return {
      name: this.request.grid ? 'grid' : 'tureen',
      plan: distinct(pipelines.flatMap(({ plan }) => plan)),
      specialisations: pipelines.flatMap(({ specialisations }) => specialisations),
      plan_ms: sum(pipelines.map(({ plan_ms }) => plan_ms)),
      upload_ms: sum(pipelines.map(({ upload_ms }) => upload_ms)),
      device_bytes: sum(pipelines.map(({ device_bytes }) => device_bytes)),
    };
  }

  private notes(added: readonly AddedScene[]): string[] {
    return distinct(added.flatMap(({ description, level }) => [
      ...description.notes,
      ...(level === null ? [] : [lowerLevelSentence(level)]),
    ]));
  }

  private described(sources: readonly Address[], added: readonly AddedScene[]) {
    const about = added.map(({ description }) => description);
    return {
      name: this.request.grid ? `${added.length} on a grid: ${distinct(about.map(({ name }) => name)).join(', ')}` : about[0]!.name,
      source: distinct(sources.map(({ url }) => url)).join(', '),
      triangles: sum(about.map(({ triangles }) => triangles)),
      appearance: distinct(about.map(({ appearance }) => appearance)).join(', '),
      readMs: sum(added.map(({ readMs }) => readMs)),
    };
  }

  private async measureAt(size: Size, added: readonly AddedScene[], configurations: readonly Configuration[],
                          tell: Tell): Promise<Measurement> {
    const { bench, request } = this;
    const cells = gridCells(added.length, size);
    for (const cell of cells) bench.setCameras(cell.scene, request.cameras, cell);
    bench.show(cells, size, 0);
    const cases: BenchCase[] = configurations.map(({ name }) => request.grid
      ? { name, grid: cells.map(({ scene }) => scene) }
      : { name, scene: 0, published: name === 'published' });
    const what = `${added.length > 1 ? `${added.length} scenes` : added[0]!.description.name}, ${sizeText(size)}`;
    const result = await bench.run(cases, { rounds: request.rounds, minSampleMs: minSampleMs() }, this.signal,
                                   (fraction) => tell(`${what}: ${fraction > 0 ? 'measuring' : 'warming up'}`, fraction));
    bench.show(cells, size, 0);
    return { ...size, cameraSet: setName(request.cameras), result };
  }
}

/** Records whether the page is hidden, from its construction to end(). */
class Hidden {
  private was = document.hidden;
  private readonly watching = new AbortController();

  constructor() {
    document.addEventListener('visibilitychange', () => { this.was ||= document.hidden; }, { signal: this.watching.signal });
  }

  end(): boolean {
    this.watching.abort();
    return this.was;
  }
}
