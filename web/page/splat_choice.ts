// The question how many splats to load, if the memory probably does not hold all.

import { type SplatOffer, ViewerError } from '../viewer/types.js';
import { button, byId, block } from '../common/dom.js';
import { bytesText, countText } from '../common/numbers.js';

/** Resolves to the chosen number. Rejects if the user cancels. */
export function chooseSplats({ name, splats, bytes, memory, fitting }: SplatOffer, signal: AbortSignal): Promise<number> {
  const dialog = byId('splat-choice', HTMLDialogElement);
  block('splat-choice-name').textContent = name;
  block('splat-choice-why').textContent =
    `Its ${countText(splats)} splats need about ${bytesText(bytes)} of memory. This page should use at most ${bytesText(memory)}.`;
  const part = button('splat-choice-part');
  part.textContent = `Load the largest ${countText(fitting)}`;
  part.value = String(fitting);
  button('splat-choice-all').value = String(splats);
  dialog.returnValue = '';
  dialog.showModal();
  return new Promise((resolve, reject) => {
    const close = () => dialog.close('');
    signal.addEventListener('abort', close);
    dialog.addEventListener('close', () => {
      signal.removeEventListener('abort', close);
      if (dialog.returnValue) resolve(Number(dialog.returnValue));
      else reject(new ViewerError('Loading was cancelled.', 'cancelled'));
    }, { once: true });
  });
}
