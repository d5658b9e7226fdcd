// The module that Emscripten builds from web/engine: only the parts that engine.ts uses.
declare module 'tureen-engine' {
  export interface TureenModule {
    HEAPU8: Uint8Array;
    blobs: readonly ArrayBuffer[];
    ccall(name: string, result: 'string', kinds: readonly string[], given: readonly unknown[]): string;
    ccall(name: string, result: 'number', kinds: readonly string[], given: readonly unknown[]): number;
    FS: {
      mkdirTree(path: string): void;
      writeFile(path: string, bytes: Uint8Array, options: { canOwn: boolean }): void;
      readFile(path: string): Uint8Array<ArrayBuffer>;
      readdir(path: string): string[];
      stat(path: string): { readonly mode: number };
      isDir(mode: number): boolean;
      unlink(path: string): void;
      rmdir(path: string): void;
    };
    GL: {
      createContext(canvas: HTMLCanvasElement, attributes: Record<string, unknown>): number;
      makeContextCurrent(context: number): boolean;
    };
  }
  /** web/engine/codecs.cpp calls these. */
  export interface Codecs {
    /** `windowBits`: as zlib's; 16 more for gzip. Returns the stream's number. */
    begin(windowBits: number): number;
    /** Places and sizes in `heap`. Returns zlib's status and the bytes left of input and output. */
    inflate(stream: number, heap: Uint8Array, input: number, inputSize: number, output: number, outputSize: number):
      readonly [number, number, number];
    end(stream: number): void;
    /** Fills `output`, and returns its size; -1 if the data are damaged or have another size. */
    unzstd(input: Uint8Array, output: Uint8Array): number;
  }
  export interface TureenHooks {
    instantiateWasm(imports: WebAssembly.Imports,
                    done: (instance: WebAssembly.Instance, module: WebAssembly.Module) => void): object;
    onProgress(fraction: number): void;
    codecs: Codecs | null;
  }
  export default function createTureen(hooks: TureenHooks): Promise<TureenModule>;
}
