// Addresses of scenes: absolute addresses, checks, and file names.

import { ViewerError, type SceneSource } from './types.js';

const fetchedProtocols: readonly string[] = ['http:', 'https:', 'blob:', 'data:'];

/** The absolute address; a relative one refers to the page. Throws ViewerError if it is not an address, or
 *  one that pages cannot fetch. */
export function urlOf({ url }: { readonly url: string }): string {
  let whole;
  try {
    whole = new URL(url, document.baseURI);
  } catch {
    throw new ViewerError(`“${url}” is not a valid address.`, 'usage');
  }
  if (whole.protocol === 'file:' || /^[a-z]:$/.test(whole.protocol))  // or C:\soup.glb
    throw new ViewerError('Pages cannot fetch files from this computer: drop the scene on the page instead.', 'usage');
  if (!fetchedProtocols.includes(whole.protocol))
    throw new ViewerError(`The protocol ${whole.protocol.slice(0, -1)} is not supported: use http or https.`, 'usage');
  return whole.href;
}

/** Encodes a query, but keeps slashes and colons, which are allowed there, readable. */
export const queryText = (text: string) => encodeURIComponent(text).replace(/%2F/g, '/').replace(/%3A/g, ':');

/** The last part of an address's path, decoded if possible; empty if the path ends with a slash. */
export function fileNameOf(url: string): string {
  const path = url.replace(/[?#].*$/s, ''), name = path.slice(path.lastIndexOf('/') + 1);
  try {
    return decodeURIComponent(name);
  } catch {
    return name;
  }
}

/** The name of a scene before it is read: its given name, or its file's name. */
export function nameOf(source: SceneSource): string {
  if (source.name) return source.name;
  if ('files' in source) return source.files[0]?.path ?? 'the scene';
  return fileNameOf(source.url.replace(/([^/])\/+(?=$|[?#])/, '$1')) || source.url;
}
