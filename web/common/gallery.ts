// The gallery: the models in models.json, next to the page. Addresses are relative to that file.
//
//   [{"name": "Tureen", "url": "soup.glb", "view": "view=three-quarter", "picture": "soup.jpg",
//     "triangles": 7000, "bytes": 2567840}]
//
// "view" is the part of a link after '#' (camera_link.ts).

import { readFragment, type LinkedView } from './camera_link.js';
import { block, make } from './dom.js';
import { bytesText, trianglesText } from './numbers.js';

export interface Model {
  readonly name: string;
  readonly url: string;
  readonly view: LinkedView;
  readonly image: string | null;
  readonly triangles: number | null;
  readonly bytes: number | null;
}

const count = (value: unknown) => (typeof value === 'number' && Number.isFinite(value) && value >= 0 ? value : null);

/** Null if the entry has no name or no address. */
function readModel(entry: unknown): Model | null {
  const { name, url, view, picture: image, triangles, bytes } = (entry ?? {}) as Record<string, unknown>;
  if (typeof name !== 'string' || typeof url !== 'string' || !url) return null;
  return {
    name, url, view: readFragment(typeof view === 'string' ? view : ''),
    image: typeof image === 'string' ? image : null,
    triangles: count(triangles), bytes: count(bytes),
  };
}

function card(model: Model, choose: (address: string, view: LinkedView) => void): HTMLElement {
  const facts = [model.triangles === null ? '' : trianglesText(model.triangles),
                 model.bytes === null ? '' : bytesText(model.bytes)];
  const image = model.image === null ? make('span', { class: 'no-image' }) :
    make('img', { src: model.image, alt: '', loading: 'lazy', width: 320, height: 200 });
  const button = make('button', { type: 'button', class: 'card' }, image,
                      make('strong', {}, model.name), make('small', {}, facts.filter(Boolean).join(' · ')));
  button.addEventListener('click', () => choose(model.url, model.view));
  return make('li', {}, button);
}

/** The site's models. A site without models.json has none, which is not an error. */
export async function readModels(): Promise<Model[]> {
  if (location.protocol === 'file:') return [];  // pages from the disk cannot fetch files
  let entries: unknown = null;
  try {
    const answer = await fetch('models.json');
    if (answer.ok) entries = await answer.json();
  } catch { /* no list, or an unreadable one */ }
  return Array.isArray(entries) ? entries.map(readModel).filter((model) => model !== null) : [];
}

/** Fills the gallery, and hides an empty one. */
export async function fillGallery(choose: (address: string, view: LinkedView) => void): Promise<void> {
  const models = await readModels();
  block('gallery-list').replaceChildren(...models.map((model) => card(model, choose)));
  block('gallery').hidden = models.length === 0;
}
