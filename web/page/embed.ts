// The page in a frame (?embed): it shows only the image and answers messages from the parent window.
// docs/web.md describes them.
//
//   {tureen: 1, id, call: 'setView', arguments: [pose, {glide: true}]}
//     gets the answer {tureen: 1, id, result} or {tureen: 1, id, error: {message, kind}}
//   {tureen: 1, event: 'view', data}    follows {call: 'subscribe', arguments: ['view']}
//   {tureen: 1, event: 'ready'}         is the first message, when the page can answer calls
//
// The page answers only the parent window. With ?origin=https://a.example (may be repeated) the window
// must have one of these origins. All data is checked like a file.

import { ViewerError, type Viewer, type ViewerEvents } from '../viewer/types.js';
import { embedCalls, withoutSources } from './embed_calls.js';
import type { Loading } from './loading.js';

interface Call {
  readonly tureen: 1;
  readonly id: string | number;
  readonly call: string;
  readonly arguments?: readonly unknown[];
}

function readCall(data: unknown): Call | null {
  const call = data as Partial<Call> | null;
  if (typeof call !== 'object' || call === null || call.tureen !== 1 || typeof call.call !== 'string') return null;
  if (typeof call.id !== 'string' && typeof call.id !== 'number') return null;
  return call.arguments === undefined || Array.isArray(call.arguments) ? (call as Call) : null;
}

/** The allowed origins; null for all. */
function allowedOrigins(): readonly string[] | null {
  const given = new URLSearchParams(location.search).getAll('origin').map((origin) => origin.replace(/\/+$/, ''));
  return given.length ? given : null;
}

/** Answers the parent window; does nothing without a frame. */
export function answerEmbedder(viewer: Viewer, loading: Loading): void {
  const parent = window.parent;
  if (parent === window) return;
  const allowed = allowedOrigins();
  // A page from the disk or in a sandbox has the origin "null", which postMessage does not accept.
  const post = (origin: string, message: object) =>
    parent.postMessage({ tureen: 1, ...message }, origin === 'null' ? '*' : origin);

  const subscribed = new Map<keyof ViewerEvents, () => void>();
  const subscribe = (event: keyof ViewerEvents, origin: string) => {
    subscribed.get(event)?.();
    subscribed.set(event, viewer.on(event, (data) =>
      post(origin, { event, data: event === 'layers' ? withoutSources(viewer.layers) : data })));
  };
  const unsubscribe = (event: keyof ViewerEvents) => {
    subscribed.get(event)?.();
    subscribed.delete(event);
  };

  window.addEventListener('message', async (event) => {
    if (event.source !== parent || (allowed && !allowed.includes(event.origin))) return;
    const call = readCall(event.data);
    if (!call) return;
    const { id, origin } = { id: call.id, origin: event.origin };
    const calls = embedCalls(viewer, loading, (name) => subscribe(name, origin), unsubscribe);
    try {
      const known = calls.get(call.call);
      if (!known) throw new ViewerError(`The call “${call.call}” does not exist.`, 'usage');
      post(origin, { id, result: await known(call.arguments ?? []) });
    } catch (error) {
      const kind = error instanceof ViewerError ? error.kind : 'usage';
      post(origin, { id, error: { message: error instanceof Error ? error.message : String(error), kind } });
    }
  });
  parent.postMessage({ tureen: 1, event: 'ready' }, '*');  // contains no private data
}
