// Messages on the page: errors, which stay until they are closed or a load begins, and notices, which
// disappear after some seconds or before newer ones. Screen readers read both.

import { type ErrorKind, ViewerError } from '../viewer/types.js';
import { block, icon, make } from './dom.js';

/** Time to read two sentences twice. */
const noticeMs = 10_000;
/** More messages would cover the image. */
const maxMessages = 3;

/** The message for a thrown value; null if the user cancelled. */
export function sentenceOf(thrown: unknown): string | null {
  if (thrown instanceof ViewerError) return thrown.kind === 'cancelled' ? null : thrown.message;
  if (thrown instanceof DOMException && thrown.name === 'AbortError') return null;
  return `Error in the page: ${thrown instanceof Error ? thrown.message : String(thrown)}`;
}

export class Messages {
  private readonly errors = block('errors');
  private readonly notices = block('notices');

  /** Shows an error and returns a function that removes it. The element's data-kind is `kind`. `hint`: a line below. */
  error(sentence: string, kind: ErrorKind | 'page', hint = ''): () => void {
    const message = this.show(this.errors, sentence, hint);
    message.dataset.kind = kind;
    return () => message.remove();
  }

  /** Shows the message for a thrown value, if it has one. `hint`: for files that cannot be read. */
  thrown(what: unknown, hint = ''): void {
    const sentence = sentenceOf(what), kind = what instanceof ViewerError ? what.kind : 'page';
    if (sentence) this.error(sentence, kind, kind === 'input' ? hint : '');
  }

  notice(sentence: string): void {
    const message = this.show(this.notices, sentence);
    // The notice stays while the pointer or the focus is on it.
    const leave = () => {
      if (message.matches(':hover, :focus-within')) setTimeout(leave, noticeMs / 4);
      else message.remove();
    };
    setTimeout(leave, noticeMs);
  }

  clearErrors(): void { this.errors.replaceChildren(); }

  private show(where: HTMLElement, sentence: string, hint = ''): HTMLElement {
    const text = make('p', {}, sentence, ...(hint ? [make('br', {}), hint] : []));
    for (const before of where.children)
      if (before.firstChild?.textContent === text.textContent) before.remove();
    const close = make('button', { type: 'button', class: 'plain', 'aria-label': 'Close this message' }, icon('close'));
    const message = make('div', { class: 'message' }, text, close);
    close.addEventListener('click', () => message.remove());
    where.append(message);
    for (const old of [...this.notices.children])
      if (this.errors.childElementCount + this.notices.childElementCount > maxMessages && old !== message) old.remove();
    return message;
  }
}
