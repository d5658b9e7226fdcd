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
  export interface TureenHooks {
    instantiateWasm(imports: WebAssembly.Imports,
                    done: (instance: WebAssembly.Instance, module: WebAssembly.Module) => void): object;
    onProgress(fraction: number): void;
  }
  export default function createTureen(hooks: TureenHooks): Promise<TureenModule>;
}
