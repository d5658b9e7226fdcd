// Sentences for the person at the page: errors, which stay until they are closed or another scene is
// asked for, and notices, which go by themselves. Screen readers read both.

import { type ErrorKind, ViewerError } from '../viewer/types.js';
import { block, icon, make } from './dom.js';

/** Long enough to read two sentences twice. */
const noticeMs = 10_000;

/** What to tell of something that was thrown; null where it is no more than a person's own cancelling. */
export function sentenceOf(thrown: unknown): string | null {
  if (thrown instanceof ViewerError) return thrown.kind === 'cancelled' ? null : thrown.message;
  if (thrown instanceof DOMException && thrown.name === 'AbortError') return null;
  return `Something went wrong in the page itself: ${thrown instanceof Error ? thrown.message : String(thrown)}`;
}

export class Messages {
  private readonly errors = block('errors');
  private readonly notices = block('notices');

  /** What it returns takes it away again. The element's data-kind is `kind`. */
  error(sentence: string, kind: ErrorKind | 'page'): () => void {
    const message = this.show(this.errors, sentence);
    message.dataset.kind = kind;
    return () => message.remove();
  }

  /** Tells of what was thrown, unless there is nothing to tell. */
  thrown(what: unknown): void {
    const sentence = sentenceOf(what);
    if (sentence) this.error(sentence, what instanceof ViewerError ? what.kind : 'page');
  }

  notice(sentence: string): void {
    const message = this.show(this.notices, sentence);
    // It waits for who reads it with the pointer or the focus on it.
    const leave = () => {
      if (message.matches(':hover, :focus-within')) setTimeout(leave, noticeMs / 4);
      else message.remove();
    };
    setTimeout(leave, noticeMs);
  }

  clearErrors(): void { this.errors.replaceChildren(); }

  private show(where: HTMLElement, sentence: string): HTMLElement {
    for (const before of where.children)
      if (before.firstChild?.textContent === sentence) before.remove();
    const close = make('button', { type: 'button', class: 'plain', 'aria-label': 'Close this message' }, icon('close'));
    const message = make('div', { class: 'message' }, make('p', {}, sentence), close);
    close.addEventListener('click', () => message.remove());
    where.append(message);
    return message;
  }
}
