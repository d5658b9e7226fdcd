// The files of a scene that names others, such as a SOG by the address of its meta.json, and its level of detail: the program
// with all formats names what is missing (web/engine/exchange.cpp), and the worker fetches it.

import type { Engine } from './engine.js';
import type { SourceToLoad } from './loader_messages.js';
import { readWith, type OpenedFiles } from './scene_files.js';
import { ViewerError } from './types.js';

/** A streamed scene has some hundred files. */
const maxFiles = 10_000;

/** Enough to keep a connection busy with small files: browsers make six connections to a server. */
const downloadsAtOnce = 8;

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

/** Calls `take` for each item, for a few at once; after the first error for no more of them. */
async function fewAtOnce<T>(items: readonly T[], take: (item: T) => Promise<void>): Promise<void> {
  const left = [...items].reverse();
  const line = async () => {
    try {
      for (let item; (item = left.pop()) !== undefined;) await take(item);
    } finally {
      left.length = 0;
    }
  };
  await Promise.all(Array.from({ length: downloadsAtOnce }, line));
}

/** `memory`, `maxSplats`: as in LoadMessage. `part`: downloads a file. Rejects with ViewerError, also if the files are larger
 *  than `memory`, which their splats then exceed, too. */
export async function planFiles(engine: Engine, files: OpenedFiles, source: SourceToLoad, memory: number, maxSplats: number | null,
                                part: (url: string) => Promise<Uint8Array<ArrayBuffer>>): Promise<PlannedFiles> {
  const bytes = new Map(files.bytes), folder = files.paths[0].replace(/[^/]*$/, ''), { lod } = source;
  const given = { memory, ...(maxSplats !== null && { max_splats: maxSplats }), ...(lod !== undefined && { lod }) };
  let size = [...bytes.values()].reduce((sum, { length }) => sum + length, 0);
  for (;;) {
    const { levels, level, missing: named } = readWith<FilePlan>(engine, 'plan_files', { bytes, paths: files.paths }, given);
    const missing = named.filter((name) => !bytes.has(folder + name));
    if (!('url' in source) || missing.length === 0)
      return { files: { bytes, paths: files.paths }, given: levels.length > 0 ? { lod: lod ?? level } : {}, levels };
    if (bytes.size + missing.length > maxFiles)
      throw new ViewerError(`${source.name} needs more than ${maxFiles.toLocaleString('en')} files.`, 'input');
    await fewAtOnce(missing, async (name) => {
      const file = await part(new URL(name.split('/').map(encodeURIComponent).join('/'), source.url).href);
      size += file.length;
      if (size > memory)
        throw new ViewerError(`The files of ${source.name} exceed the memory for splats, ${memory.toLocaleString('en')} bytes` +
                              `${levels.length > 1 ? ': choose a coarser level of detail' : ''}.`, 'memory');
      bytes.set(folder + name, file);
    });
  }
}
