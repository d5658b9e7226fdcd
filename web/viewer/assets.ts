// What the viewer needs beside its own script: the engine and the worker that loads scenes.

import { ViewerError } from './types.js';

export interface Assets {
  /** The bytes of tureen.wasm. */
  wasm(): Promise<ArrayBuffer>;
  /** A new worker that runs the loader. Rejects with ViewerError where its script cannot be had. */
  loaderWorker(): Promise<Worker>;
}

async function fetched(url: URL): Promise<Response> {
  const response = await fetch(url).catch(() => null);
  if (!response?.ok) throw new ViewerError(`A part of the viewer, ${url.href}, cannot be had.`, 'network');
  return response;
}

const known = new Map<string, Assets>();

/** Files at this address; beside this script where none is given. All are fetched at once and kept, so
 *  that scenes can be opened when the network has gone. */
export function assetsAt(address?: string): Assets {
  const base = address === undefined ? import.meta.url : new URL(address.replace(/\/?$/, '/'), document.baseURI).href;
  const assets = known.get(base) ?? fetchedFrom(base);
  known.set(base, assets);
  return assets;
}

function fetchedFrom(base: string): Assets {
  const script = fetched(new URL('loader_worker.js', base))
    .then(async (response) => URL.createObjectURL(new Blob([await response.text()], { type: 'text/javascript' })));
  script.catch(() => { known.delete(base); });  // who wants a worker is told; the next one may have better luck
  return {
    wasm: async () => (await fetched(new URL('tureen.wasm', base))).arrayBuffer(),
    loaderWorker: async () => new Worker(await script),
  };
}
