// The files of a scene that names others, such as a SOG by the address of its meta.json, and its level of detail: the program
// with all formats names what is missing (web/engine/exchange.cpp), and the worker fetches it.

import type { Engine } from './engine.js';
import type { SourceToLoad } from './loader_messages.js';
import { readWith, type OpenedFiles } from './scene_files.js';
import { ViewerError } from './types.js';

/** A streamed scene has some hundred files. */
const maxFiles = 10_000;

/** web/engine/exchange.cpp */
interface FilePlan {
  /** Splats by level of detail; empty if it has none. */
  readonly levels: readonly number[];
  readonly level: number;
  readonly missing: readonly string[];
}

export interface PlannedFiles {
  readonly files: OpenedFiles;
  /** Further arguments of commands that read them: the level. */
  readonly given: { readonly lod?: number };
  readonly levels: readonly number[];
}

/** `memory`, `maxSplats`: as in LoadMessage. `part`: downloads a file. Rejects with ViewerError. */
export async function planFiles(engine: Engine, files: OpenedFiles, source: SourceToLoad, memory: number, maxSplats: number | null,
                                part: (url: string) => Promise<Uint8Array<ArrayBuffer>>): Promise<PlannedFiles> {
  const bytes = new Map(files.bytes), folder = files.paths[0].replace(/[^/]*$/, ''), { lod } = source;
  const given = { memory, ...(maxSplats !== null && { max_splats: maxSplats }), ...(lod !== undefined && { lod }) };
  for (;;) {
    const { levels, level, missing } = readWith<FilePlan>(engine, 'plan_files', { bytes, paths: files.paths }, given);
    if (!('url' in source) || missing.length === 0)
      return { files: { bytes, paths: files.paths }, given: levels.length > 0 ? { lod: lod ?? level } : {}, levels };
    if (bytes.size + missing.length > maxFiles)
      throw new ViewerError(`${source.name} needs more than ${maxFiles.toLocaleString('en')} files.`, 'input');
    await Promise.all(missing.map(async (name) => {
      bytes.set(folder + name, await part(new URL(name.split('/').map(encodeURIComponent).join('/'), source.url).href));
    }));
  }
}
