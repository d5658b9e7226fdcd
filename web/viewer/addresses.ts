// Addresses of scenes: whole ones, those that can be fetched, and the names of their files.

import { ViewerError, type SceneSource } from './types.js';

const fetchedProtocols: readonly string[] = ['http:', 'https:', 'blob:', 'data:'];

/** Whole, where it is relative to the page's. Throws ViewerError where it is no address, or one that pages
 *  cannot fetch. */
export function urlOf({ url }: { readonly url: string }): string {
  let whole;
  try {
    whole = new URL(url, document.baseURI);
  } catch {
    throw new ViewerError(`“${url}” is no address of a scene.`, 'usage');
  }
  if (whole.protocol === 'file:' || /^[a-z]:$/.test(whole.protocol))  // or C:\soup.glb
    throw new ViewerError('Pages cannot fetch files of this computer; drop the scene on the page instead.', 'usage');
  if (!fetchedProtocols.includes(whole.protocol))
    throw new ViewerError(`Scenes are fetched by http and https, not by ${whole.protocol.slice(0, -1)}.`, 'usage');
  return whole.href;
}

/** The last part of an address's path, readable where it can be decoded; empty where it ends in a slash. */
export function fileNameOf(url: string): string {
  const path = url.replace(/[?#].*$/s, ''), name = path.slice(path.lastIndexOf('/') + 1);
  try {
    return decodeURIComponent(name);
  } catch {
    return name;
  }
}

/** What people know a scene by before it is read: its given name, or that of its file. */
export function nameOf(source: SceneSource): string {
  if (source.name) return source.name;
  if ('files' in source) return source.files[0]?.path ?? 'the scene';
  return fileNameOf(source.url.replace(/([^/])\/+(?=$|[?#])/, '$1')) || source.url;
}
