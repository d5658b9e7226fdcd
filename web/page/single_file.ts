// The page as one file that opens from the disk: engine and worker are in it as base64, and so is
// the scene that `tureen convert SCENE page.html` put there. Nothing is fetched.

import type { Assets } from '../viewer/assets.js';
import type { SceneSource } from '../viewer/types.js';
import { openViewerPage } from './viewer_page.js';

/** Four characters are three bytes; a piece is small enough for atob and a multiple of four. */
const piece = 1 << 20;

/** The bytes that an element of the page has as its text, without white space; null where it is
 *  empty. The text is given up: it may be the larger part of the page. */
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
      if (!engine) throw new Error('This page is not whole: its engine is missing.');
      return engine.slice().buffer;  // whoever gets it may hand it on to a worker
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
