// Writes scenes as one file, in a worker with the program of all formats, which reads the sources again.

import { compile } from './engine.js';
import type { FromLoader, ToLoader, WriteMessage } from './loader_messages.js';
import { ViewerError, type Assets, type LoadProgress, type WrittenScene } from './types.js';

const noProgram = 'This page, in one file, writes no scenes: use tureen convert.';

/** The element of the page as one file, which `tureen convert` fills, too (web/build.mjs). */
const scenePart = /(<script type="application\/octet-stream;base64" id="scene" data-name=")(">)(<\/script>)/;

/** Base64, by the browser. */
async function base64(bytes: Blob): Promise<string> {
  const reader = new FileReader();
  const done = new Promise((resolve, reject) => {
    reader.onload = resolve;
    reader.onerror = () => reject(new ViewerError('The page has not enough memory for the file.', 'memory'));
  });
  reader.readAsDataURL(bytes);
  await done;
  const url = reader.result as string;
  return url.slice(url.indexOf(',') + 1);
}

/** The page as one file with a GLB. */
export async function pageWith(assets: Assets, glb: Blob, name: string): Promise<Blob> {
  if (!assets.template) throw new ViewerError(noProgram, 'usage');
  const parts = (await assets.template()).split(scenePart);
  if (parts.length !== 5) throw new ViewerError('scene_template.html is not the page as one file.', 'network');
  const escaped = name.replace(/[&"<]/g, (letter) => `&#${letter.charCodeAt(0)};`);
  return new Blob([parts[0]!, parts[1]!, escaped, parts[2]!, await base64(glb), parts[3]!, parts[4]!], { type: 'text/html' });
}

/** Each of the signals cancels it. Rejects with ViewerError. */
export async function writeFile(assets: Assets, message: Omit<WriteMessage, 'kind'>, signals: readonly AbortSignal[],
                                progress: (progress: LoadProgress) => void): Promise<WrittenScene> {
  if (!assets.further) throw new ViewerError(noProgram, 'usage');
  const compiling = compile(assets.further);
  compiling.catch(() => {});  // awaited after the worker
  const worker = await assets.further.loaderWorker();
  let cancel = () => {};
  try {
    const program = await compiling;
    return await new Promise((resolve, reject) => {
      cancel = () => reject(new ViewerError('Writing was cancelled.', 'cancelled'));
      if (signals.some(({ aborted }) => aborted)) return cancel();
      for (const signal of signals) signal.addEventListener('abort', cancel);
      worker.onerror = (event) => {
        event.preventDefault();
        reject(new ViewerError(`The writer cannot run: ${event.message || 'its script is incomplete'}.`, 'device'));
      };
      worker.onmessage = ({ data }: MessageEvent<FromLoader>) => {
        if (data.kind === 'progress') progress(data.progress);
        else if (data.kind === 'error') reject(new ViewerError(data.error.message, data.error.kind));
        else if (data.kind === 'written') resolve({ file: new Blob([data.bytes]), losses: data.losses });
      };
      worker.postMessage({ kind: 'program', program } satisfies ToLoader);
      worker.postMessage({ kind: 'write', ...message } satisfies ToLoader);
    });
  } finally {
    for (const signal of signals) signal.removeEventListener('abort', cancel);
    worker.terminate();
  }
}
