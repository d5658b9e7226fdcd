// The page in somebody's frame (?embed): it shows the image alone and obeys messages of the window
// that it is framed by. docs/web.md describes them.
//
//   {tureen: 1, id, call: 'setView', arguments: [pose, {glide: true}]}
//     is answered by {tureen: 1, id, result} or {tureen: 1, id, error: {message, kind}}
//   {tureen: 1, event: 'view', data}    comes after {call: 'subscribe', arguments: ['view']}
//   {tureen: 1, event: 'ready'}         comes first, once calls are answered
//
// Only the parent window is heard, and with ?origin=https://a.example (which may be repeated) only
// while it is of one of these origins. Whatever comes is checked as a file would be.

import { ViewerError, type Viewer, type ViewerEvents } from '../viewer/types.js';
import { embedCalls } from './embed_calls.js';
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

/** Null: everyone's. */
function allowedOrigins(): readonly string[] | null {
  const given = new URLSearchParams(location.search).getAll('origin').map((origin) => origin.replace(/\/+$/, ''));
  return given.length ? given : null;
}

/** Answers the window that frames this page; none does where it was opened by itself. */
export function answerEmbedder(viewer: Viewer, loading: Loading): void {
  const parent = window.parent;
  if (parent === window) return;
  const allowed = allowedOrigins();
  // A page from the disk or in a sandbox is of the origin "null", which cannot be addressed.
  const post = (origin: string, message: object) =>
    parent.postMessage({ tureen: 1, ...message }, origin === 'null' ? '*' : origin);

  const subscribed = new Map<keyof ViewerEvents, () => void>();
  const subscribe = (event: keyof ViewerEvents, origin: string) => {
    subscribed.get(event)?.();
    subscribed.set(event, viewer.on(event, (data) => post(origin, { event, data })));
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
      if (!known) throw new ViewerError(`There is no call named “${call.call}”.`, 'usage');
      post(origin, { id, result: await known(call.arguments ?? []) });
    } catch (error) {
      const kind = error instanceof ViewerError ? error.kind : 'usage';
      post(origin, { id, error: { message: error instanceof Error ? error.message : String(error), kind } });
    }
  });
  parent.postMessage({ tureen: 1, event: 'ready' }, '*');  // which is no secret
}
