// The files that the viewer needs besides its script: the engine, and the worker that loads scenes.

import { ViewerError, type Assets } from './types.js';

async function fetched(url: URL): Promise<Response> {
  const response = await fetch(url).catch(() => null);
  if (!response?.ok) throw new ViewerError(`A file of the viewer cannot be loaded: ${url.href}.`, 'network');
  return response;
}

const known = new Map<string, Assets>();

/** The files at this address, by default next to this script. All are fetched early and kept, so scenes
 *  can be opened without a network later. */
export function assetsAt(address?: string): Assets {
  const base = address === undefined ? import.meta.url : new URL(address.replace(/\/?$/, '/'), document.baseURI).href;
  const assets = known.get(base) ?? fetchedFrom(base);
  known.set(base, assets);
  return assets;
}

/** The worker's script: the engine's without its last line, which exports createTureen, and the loader's (build.mjs). */
async function workerScript(base: string, names: readonly string[]): Promise<string> {
  const [engine, loader] = await Promise.all(names.map(
    async (name) => (await fetched(new URL(name, base))).text()));
  const script = engine!.slice(0, engine!.lastIndexOf('export default'));
  return URL.createObjectURL(new Blob([script, loader!], { type: 'text/javascript' }));
}

function fetchedFrom(base: string): Assets {
  const script = workerScript(base, ['tureen.js', 'loader_worker.js']);
  script.catch(() => { known.delete(base); });  // the next call tries again; loaderWorker() reports the error
  const fileOf = (name: string) => fetched(new URL(name, base));
  let further: Promise<string> | null = null;
  return {
    wasm: async () => (await fileOf('tureen.wasm')).arrayBuffer(),
    loaderWorker: async () => new Worker(await script),
    further: {
      wasm: async () => (await fileOf('tureen_formats.wasm')).arrayBuffer(),
      loaderWorker: async () => {
        further ??= workerScript(base, ['tureen_formats.js', 'formats_worker.js']);
        further.catch(() => { further = null; });
        return new Worker(await further);
      },
    },
    template: async () => (await fileOf('scene_template.html')).text(),
  };
}
