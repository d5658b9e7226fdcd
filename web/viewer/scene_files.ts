// The files of a scene in the form that the engine reads: one file, or a folder.

import type { Engine } from './engine.js';
import { kinds } from './formats.js';
import { ViewerError, type SceneFile } from './types.js';

/** The engine's folder for files; paths in errors are relative to it. */
const folder = '/scene';

export interface OpenedFiles {
  readonly bytes: ReadonlyMap<string, Uint8Array<ArrayBuffer>>;
  /** Candidates for the scene: the folder of several files, then the file that refers to the others. */
  readonly paths: readonly [string, ...string[]];
}

export function oneFile(name: string, bytes: Uint8Array<ArrayBuffer>): OpenedFiles {
  const path = name.replaceAll('/', ' ');
  return { bytes: new Map([[path, bytes]]), paths: [path] };
}

export async function openFiles(files: readonly SceneFile[], name: string): Promise<OpenedFiles> {
  const bytesOf = async ({ path, data }: SceneFile) => new Uint8Array(await data.arrayBuffer().catch(() => {
    throw new ViewerError(`${path} cannot be read: it was changed, moved or removed. Open it again.`, 'input');
  }));
  if (files.length === 1) return oneFile(files[0]!.path, await bytesOf(files[0]!));
  const whole = name.replaceAll('/', ' '), bytes = new Map<string, Uint8Array<ArrayBuffer>>();
  for (const file of files) bytes.set(`${whole}/${file.path}`, await bytesOf(file));
  const alone = kinds
    .map(({ end }) => [...bytes.keys()].filter((path) => path.toLowerCase().endsWith(end)))
    .filter((fitting) => fitting.length === 1)
    .map(([path]) => path!);
  return { bytes, paths: [whole, ...alone.slice(0, 1)] };
}

/** Runs a command of the engine that reads the files, and then removes them. `more`: further arguments of
 *  the command. Throws ViewerError. */
export function readWith<T>(engine: Engine, command: string, files: OpenedFiles, more: object = {}): T {
  try {
    engine.putFiles(folder, files.bytes);
    return engine.call<T>(command, { ...more, folder, paths: files.paths });
  } finally {
    engine.emptyFolder(folder);
  }
}
