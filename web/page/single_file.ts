// The page as one file that opens from the disk. It contains the engine, the worker and the scene from
// `tureen convert SCENE page.html` as base64, and fetches nothing.

import type { Assets, SceneSource } from '../viewer/types.js';
import { openViewerPage } from './viewer_page.js';

/** Characters per call of atob: a multiple of four, because four characters are three bytes. */
const piece = 1 << 20;

/** Decodes the base64 text of an element, which must contain no white space inside; null if it is empty.
 *  Clears the text, which may be most of the page. */
function takeBytes(id: string): Uint8Array<ArrayBuffer> | null {
  const element = document.getElementById(id);
  const text = element?.textContent?.trim() ?? '';
  if (!text) return null;
  element!.textContent = '';
  const padding = text.endsWith('==') ? 2 : text.endsWith('=') ? 1 : 0;
  const bytes = new Uint8Array((text.length / 4) * 3 - padding);
  let end = 0;
  for (let at = 0; at < text.length; at += piece) {
    const part = atob(text.slice(at, at + piece));
    for (let i = 0; i < part.length; ++i) bytes[end++] = part.charCodeAt(i);
  }
  return bytes;
}

function partsOf(): Assets {
  const engine = takeBytes('engine'), worker = takeBytes('worker');
  const script = URL.createObjectURL(new Blob(worker ? [worker] : [], { type: 'text/javascript' }));
  return {
    async wasm() {
      if (!engine) throw new Error('This page is incomplete: its engine is missing.');
      return engine.slice().buffer;  // a copy: the caller may transfer it to a worker
    },
    loaderWorker: async () => new Worker(script),
  };
}

function sceneOf(): SceneSource | null {
  const name = document.getElementById('scene')?.dataset.name || 'scene.glb';
  const bytes = takeBytes('scene');
  return bytes && { name, files: [{ path: name, data: new Blob([bytes]) }] };
}

void openViewerPage({ assets: partsOf(), scene: sceneOf() });
