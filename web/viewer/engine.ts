// One instance of the engine: WebAssembly, its memory, and named commands (web/engine/commands.hpp).
// A page has one instance for drawing. Each load has another in a worker, which frees all its memory.

import createTureen, { type Codecs, type TureenModule } from 'tureen-engine';
import { ViewerError, type Assets } from './types.js';

type Failure = { readonly kind: ViewerError['kind']; readonly message: string };

/** A prepared scene's bytes: web/engine/prepared_archive.hpp. */
export interface Parcel {
  readonly head: ArrayBuffer;
  readonly blobs: readonly ArrayBuffer[];
}

/** A module with one function, which returns a vector: i32x4.splat(0). */
const vectors = new Uint8Array([
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 8, 1, 6, 0, 65, 0, 253, 17, 11,
]);

const compiled = new WeakMap<Pick<Assets, 'wasm'>, Promise<WebAssembly.Module>>();
const utf8 = new TextEncoder();

let codecs: Codecs | null = null;
/** For later engines of the program that reads all formats. */
export function useCodecs(given: Codecs): void { codecs = given; }

/** The program, compiled once for all instances. Rejects with ViewerError. */
export function compile(assets: Pick<Assets, 'wasm'>): Promise<WebAssembly.Module> {
  let program = compiled.get(assets);
  if (!program) {
    program = WebAssembly.validate(vectors) ? assets.wasm().then((bytes) => WebAssembly.compile(bytes))
                                            : Promise.reject(new ViewerError(tooOld, 'device'));
    compiled.set(assets, program);
    program.catch(() => { compiled.delete(assets); });  // the next viewer tries again
  }
  return program;
}

export class Engine {
  /** Called with 0..1 during long commands. */
  onProgress: ((fraction: number) => void) | null = null;

  /** The engine in its memory, for all its functions. */
  private readonly self: number;

  private constructor(private readonly module: TureenModule) {
    this.self = module.ccall('tureen_engine', 'number', [], []);
  }

  /** Rejects with ViewerError if there is no memory for another instance. */
  static async create(program: WebAssembly.Module): Promise<Engine> {
    let engine: Engine | null = null;
    const module = await new Promise<TureenModule>((resolve, reject) => {
      createTureen({
        instantiateWasm: (imports, done) => {
          WebAssembly.instantiate(program, imports).then((instance) => done(instance, program), reject);
          return {};
        },
        onProgress: (fraction) => engine?.onProgress?.(fraction),
        codecs,
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
      const at = this.module.ccall('tureen_arguments', 'number', ['number', 'number'], [this.self, json.length]);
      if (at === 0) throw new RangeError('no memory for the command');
      this.module.HEAPU8.set(json, at);
      return this.module.ccall('tureen_call', 'string', ['number', 'string'], [this.self, name]);
    } catch (trap) {
      // WebAssembly traps if its memory cannot grow or its stack overflows.
      throw new ViewerError(`The engine has stopped (${trap instanceof Error ? trap.message : String(trap)}): ` +
                            'the probable cause is too little memory for this scene.', 'memory');
    }
  }

  /** Sets the bytes for the next command: those of all parts, one after the other. */
  setBuffer(...parts: readonly Uint8Array[]): void {
    const size = parts.reduce((sum, { length }) => sum + length, 0);
    let at = this.module.ccall('tureen_buffer', 'number', ['number', 'number'], [this.self, size]);
    if (at === 0 && size > 0)
      throw new ViewerError('The page has not enough memory for this scene.', 'memory');
    for (const part of parts) {
      this.module.HEAPU8.set(part, at);
      at += part.length;
    }
  }

  /** The bytes from the last command; a view of memory that is valid until the next call. */
  buffer(): Uint8Array {
    const at = this.module.ccall('tureen_buffer', 'number', ['number', 'number'], [this.self, -1]);
    const size = this.module.ccall('tureen_buffer_size', 'number', ['number'], [this.self]);
    return this.module.HEAPU8.subarray(at, at + size);
  }

  /** Runs a command that takes a prepared scene. An empty head was given before (arriving_scene.ts). */
  give<T>({ head, blobs }: Parcel, command: string, given: object): T {
    if (head.byteLength > 0) this.takeHead(head);
    this.module.blobs = blobs;
    try {
      return this.call<T>(command, given);
    } finally {
      this.module.blobs = [];
    }
  }

  takeHead(head: ArrayBuffer): void {
    this.setBuffer(new Uint8Array(head));
    this.call('take_head');
  }

  /** Adds files for the engine below `folder`, without a copy of their bytes. */
  putFiles(folder: string, files: ReadonlyMap<string, Uint8Array>): void {
    for (const [path, bytes] of files) {
      const whole = `${folder}/${path}`;
      this.module.FS.mkdirTree(whole.slice(0, whole.lastIndexOf('/')));
      this.module.FS.writeFile(whole, bytes, { canOwn: true });
    }
  }

  /** The bytes of a file that a command has written, which is removed. */
  takeFile(path: string): Uint8Array<ArrayBuffer> {
    const bytes = this.module.FS.readFile(path);
    this.module.FS.unlink(path);
    return bytes;
  }

  /** Removes the contents of a folder. The folder itself stays: it is the engine's current folder. */
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

  /** Creates this engine's context on the canvas. Throws ViewerError without WebGL2. */
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

const tooOld =
  'This browser is too old: the engine needs WebAssembly with SIMD. Use Chrome 95, Firefox 100, Safari 16.4, or a ' +
  'newer version.';

const noWebGl2 =
  'This browser does not provide WebGL2, which is needed to draw. Use a newer browser, or turn on hardware ' +
  'acceleration in its settings.';
