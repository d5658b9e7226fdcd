// What the viewer needs beside its own script: the engine and the worker that loads scenes.

import { ViewerError } from './types.js';

export interface Assets {
  /** The bytes of tureen.wasm. */
  wasm(): Promise<ArrayBuffer>;
  /** A new worker that runs the loader. */
  loaderWorker(): Worker;
}

/** Files at this address; beside this script where none is given. */
export function assetsAt(address?: string): Assets {
  const base = address === undefined ? import.meta.url : new URL(address.replace(/\/?$/, '/'), document.baseURI);
  return {
    async wasm() {
      const url = new URL('tureen.wasm', base);
      const response = await fetch(url).catch(() => null);
      if (!response?.ok) throw new ViewerError(`The engine, ${url.href}, cannot be had.`, 'network');
      return response.arrayBuffer();
    },
    loaderWorker: () => new Worker(new URL('loader_worker.js', base), { type: 'module' }),
  };
}
