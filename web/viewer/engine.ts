// One instance of the engine: WebAssembly, its memory, and commands by name (web/engine/commands.hpp).
// A page has one that draws; each load has another, in a worker, that is gone with what it has used.

import createTureen, { type TureenModule } from 'tureen-engine';
import type { Assets } from './assets.js';
import { ViewerError } from './types.js';

type Failure = { readonly kind: ViewerError['kind']; readonly message: string };

/** A scene's bytes on their way to the device: web/engine/prepared_archive.hpp. */
export interface Parcel {
  readonly head: ArrayBuffer;
  readonly blobs: readonly ArrayBuffer[];
}

const compiled = new WeakMap<Assets, Promise<WebAssembly.Module>>();
const utf8 = new TextEncoder();

/** The program, compiled once for all instances. Rejects with ViewerError. */
export function compile(assets: Assets): Promise<WebAssembly.Module> {
  let program = compiled.get(assets);
  if (!program) {
    program = assets.wasm().then((bytes) => WebAssembly.compile(bytes));
    compiled.set(assets, program);
    program.catch(() => { compiled.delete(assets); });  // the next viewer may have better luck
  }
  return program;
}

export class Engine {
  /** Called with 0..1 while a long command is under way. */
  onProgress: ((fraction: number) => void) | null = null;

  private constructor(private readonly module: TureenModule) {}

  /** Rejects with ViewerError where there is no memory for another instance. */
  static async create(program: WebAssembly.Module): Promise<Engine> {
    let engine: Engine | null = null;
    const module = await new Promise<TureenModule>((resolve, reject) => {
      createTureen({
        instantiateWasm: (imports, done) => {
          WebAssembly.instantiate(program, imports).then((instance) => done(instance, program), reject);
          return {};
        },
        onProgress: (fraction) => engine?.onProgress?.(fraction),
      }).then(resolve, reject);
    }).catch((error: unknown) => {
      throw new ViewerError(`The engine cannot start: ${String(error)}.`, 'memory');
    });
    return engine = new Engine(module);
  }

  /** Throws ViewerError. */
  call<T = null>(name: string, given: unknown = null): T {
    const answer = JSON.parse(this.ask(name, given)) as { result: T } | { error: Failure };
    if ('result' in answer) return answer.result;
    throw new ViewerError(answer.error.message, answer.error.kind);
  }

  private ask(name: string, given: unknown): string {
    const json = utf8.encode(JSON.stringify(given));
    try {
      const at = this.module.ccall('tureen_arguments', 'number', ['number'], [json.length]);
      if (at === 0) throw new RangeError('no room for what it is asked');
      this.module.HEAPU8.set(json, at);
      return this.module.ccall('tureen_call', 'string', ['string'], [name]);
    } catch (trap) {
      // What WebAssembly does where memory cannot grow, or the stack ends.
      throw new ViewerError(`The engine has stopped (${trap instanceof Error ? trap.message : String(trap)}): ` +
                            'most likely there is not enough memory for this scene.', 'memory');
    }
  }

  /** The bytes that go with the next command. */
  setBuffer(bytes: Uint8Array): void {
    const at = this.module.ccall('tureen_buffer', 'number', ['number'], [bytes.length]);
    if (at === 0 && bytes.length > 0)
      throw new ViewerError('There is not enough memory for this scene in a page.', 'memory');
    this.module.HEAPU8.set(bytes, at);
  }

  /** The bytes that came with the last command; a view of memory that the next call may move. */
  buffer(): Uint8Array {
    const at = this.module.ccall('tureen_buffer', 'number', ['number'], [-1]);
    const size = this.module.ccall('tureen_buffer_size', 'number', [], []);
    return this.module.HEAPU8.subarray(at, at + size);
  }

  /** What the engine reads of the parcels that are being unpacked. */
  setBlobs(blobs: readonly ArrayBuffer[]): void { this.module.blobs = blobs; }

  /** Files for the engine to read, each at its path below `folder`; without a copy of their bytes. */
  putFiles(folder: string, files: ReadonlyMap<string, Uint8Array>): void {
    for (const [path, bytes] of files) {
      const whole = `${folder}/${path}`;
      this.module.FS.mkdirTree(whole.slice(0, whole.lastIndexOf('/')));
      this.module.FS.writeFile(whole, bytes, { canOwn: true });
    }
  }

  /** The folder itself stays: it is where the engine is. */
  emptyFolder(folder: string): void {
    const { FS } = this.module;
    for (const name of FS.readdir(folder)) {
      if (name === '.' || name === '..') continue;
      const path = `${folder}/${name}`;
      if (!FS.isDir(FS.stat(path).mode)) {
        FS.unlink(path);
      } else {
        this.emptyFolder(path);
        FS.rmdir(path);
      }
    }
  }

  /** Makes the canvas's context this engine's. Throws ViewerError where there is no WebGL2. */
  takeCanvas(canvas: HTMLCanvasElement): void {
    const context = this.module.GL.createContext(canvas, {
      majorVersion: 2, minorVersion: 0, alpha: false, depth: false, stencil: false, antialias: false,
      premultipliedAlpha: true, preserveDrawingBuffer: false, powerPreference: 'high-performance',
      failIfMajorPerformanceCaveat: false, enableExtensionsByDefault: true,
    });
    if (!context) throw new ViewerError(noWebGl2, 'no-webgl2');
    this.module.GL.makeContextCurrent(context);
  }

  get memoryBytes(): number { return this.module.HEAPU8.length; }
}

const noWebGl2 =
  'This browser gives no WebGL2, which drawing needs. A newer browser has it, or the same one with ' +
  'hardware acceleration switched on in its settings.';
