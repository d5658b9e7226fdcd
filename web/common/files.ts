// Dropped or picked files as scenes. Paths are relative to the scene's folder, without its name. Several
// files or a folder are one scene, with two exceptions: several files of kinds that need no other file, and
// several folders, are a scene each.

import { isAlone } from '../viewer/formats.js';
import { ViewerError, type SceneFile, type SceneSource } from '../viewer/types.js';

/** More files than any scene has, but fewer than a home folder that was dropped by mistake. */
const maxFiles = 10_000;

function tooMany(): ViewerError {
  const most = maxFiles.toLocaleString('en');
  return new ViewerError(`There are more than ${most} files: choose the folder of the scene itself.`, 'input');
}

/** Names the scene after its folder, or after its first file without a folder. */
function sourceOf(files: readonly SceneFile[], folder: string | null): SceneSource {
  if (files.length === 0)
    throw new ViewerError(folder ? `The folder ${folder} is empty.` : 'No file was chosen.', 'input');
  return { files, name: folder ?? files[0]!.path };
}

/** One scene, or one for each file if all of them are scenes alone. */
function sourcesOf(files: readonly SceneFile[], folder: string | null): readonly SceneSource[] {
  if (folder === null && files.length > 1 && files.every(({ path }) => isAlone(path)))
    return files.map((file) => sourceOf([file], null));
  return [sourceOf(files, folder)];
}

/** Whether a source has the names of photographs or of their dataset. An only file may be a photograph, too. */
export function hasPhotographs(source: SceneSource): boolean {
  const names = 'files' in source ? source.files.map(({ path }) => path) : [source.url];
  return names.some((name) => /(?:\.jpe?g|\btransforms\w*\.json|\bcameras\.(?:bin|txt))$/i.test(name)) ||
    (names.length === 1 && /\.png$/i.test(names[0]!));
}

/** The scenes of an <input type=file>, with or without webkitdirectory. */
export function sourcesOfPicked(list: FileList): readonly SceneSource[] {
  if (list.length > maxFiles) throw tooMany();
  const first = list[0]?.webkitRelativePath ?? '';
  const folder = first.includes('/') ? first.slice(0, first.indexOf('/')) : null;
  const path = (file: File) => folder === null ? file.name : file.webkitRelativePath.slice(folder.length + 1);
  return sourcesOf([...list].map((file) => ({ path: path(file), data: file })), folder);
}

const fileOf = (entry: FileSystemFileEntry) =>
  new Promise<File>((resolve, reject) => entry.file(resolve, reject));

/** All entries of a folder. A reader returns at most 100 entries per call, and none at the end. */
async function entriesOf(folder: FileSystemDirectoryEntry): Promise<FileSystemEntry[]> {
  const reader = folder.createReader();
  const all: FileSystemEntry[] = [];
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (some.length === 0) return all;
    all.push(...some);
  }
}

async function collect(folder: FileSystemDirectoryEntry, path: string, files: SceneFile[]): Promise<void> {
  for (const entry of await entriesOf(folder)) {
    if (files.length >= maxFiles) throw tooMany();
    const inner = path + entry.name;
    if (entry.isDirectory) await collect(entry as FileSystemDirectoryEntry, `${inner}/`, files);
    else files.push({ path: inner, data: await fileOf(entry as FileSystemFileEntry) });
  }
}

/** The scenes of a drop. Call it within the event: `transfer` is empty afterwards. */
export function sourcesOfDropped(transfer: DataTransfer): Promise<readonly SceneSource[]> {
  // A page from the disk gets the dropped files, but the browser may refuse to read their entries.
  const items = [...transfer.items].filter((item) => item.kind === 'file')
    .map((item) => ({ entry: item.webkitGetAsEntry?.() ?? null, file: item.getAsFile() }));
  return (async () => {
    const folders = items.flatMap(({ entry }) => (entry?.isDirectory ? [entry as FileSystemDirectoryEntry] : []));
    try {
      if (folders.length > 0 && folders.length === items.length) {
        const sources: SceneSource[] = [];
        for (const folder of folders) {
          const files: SceneFile[] = [];
          await collect(folder, '', files);
          sources.push(sourceOf(files, folder.name));
        }
        return sources;
      }
      const files: SceneFile[] = [];
      for (const { entry, file } of items)
        if (entry?.isDirectory) await collect(entry as FileSystemDirectoryEntry, `${entry.name}/`, files);
        else if (file) files.push({ path: file.name, data: file });
      return folders.length ? [sourceOf(files, null)] : sourcesOf(files, null);
    } catch (error) {
      if (error instanceof ViewerError) throw error;
      throw new ViewerError(
        'The browser could not read the dropped folder: choose it with the button instead.', 'input');
    }
  })();
}
