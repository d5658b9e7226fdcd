// Bytes of an address as they arrive, in one growing piece of memory.

import { ViewerError } from './types.js';

/** A server need not say how much is to come; more is asked for as it comes. */
const firstGuess = 1 << 20;

export interface Arrival {
  /** All that has come so far; a view that the next arrival may leave behind. */
  readonly bytes: Uint8Array<ArrayBuffer>;
  /** null where the server does not say. */
  readonly total: number | null;
}

/** How many bytes are to come: what was packed for the way says nothing of what comes out of it. */
function announced(response: Response): number | null {
  const length = Number(response.headers.get('content-length'));
  return length > 0 && !response.headers.get('content-encoding') ? length : null;
}

async function request(url: string): Promise<Response> {
  let response;
  try {
    response = await fetch(url);
  } catch {
    throw new ViewerError(`${url} cannot be reached: there is no network, or the server does not let pages ` +
                          'of other addresses read it (CORS).', 'network');
  }
  if (!response.ok) {
    const answer = [response.status, response.statusText].filter(Boolean).join(' ');  // HTTP/2 has no text
    throw new ViewerError(`${url} cannot be had: the server answers ${answer}.`, 'network');
  }
  return response;
}

function room(url: string, bytes: number): Uint8Array<ArrayBuffer> {
  try {
    return new Uint8Array(bytes);
  } catch {
    throw new ViewerError(`There is not enough memory for the ${bytes.toLocaleString('en')} bytes of ${url}.`, 'memory');
  }
}

/** Calls `arrived` with each piece that comes, and waits for it before the next. Rejects with ViewerError. */
export async function download(url: string, arrived: (arrival: Arrival) => void | Promise<void>): Promise<Uint8Array<ArrayBuffer>> {
  const response = await request(url);
  let total = announced(response), size = 0;
  let memory = room(url, total ?? firstGuess);
  const reader = response.body!.getReader();
  for (;;) {
    const { done, value } = await reader.read().catch(() => {
      throw new ViewerError(`${url} broke off after ${size.toLocaleString('en')} bytes.`, 'network');
    });
    if (done) break;
    if (size + value.length > memory.length) {
      total = null;  // of another server it is not told that it packs what it sends
      const larger = room(url, Math.max(2 * memory.length, size + value.length));
      larger.set(memory.subarray(0, size));
      memory = larger;
    }
    memory.set(value, size);
    size += value.length;
    try {
      await arrived({ bytes: memory.subarray(0, size), total });
    } catch (error) {
      void reader.cancel().catch(() => {});  // the server need not go on
      throw error;
    }
  }
  return memory.subarray(0, size);
}
