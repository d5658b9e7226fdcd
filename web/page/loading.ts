// The loading of a scene: progress as text and bar, the Cancel button, and the error message. A new load
// cancels the previous one.

import { nameOf } from '../viewer/addresses.js';
import type { LoadProgress, LoadStage, SceneLayer, SceneSource, SceneSummary, Viewer } from '../viewer/types.js';
import { block, button } from '../common/dom.js';
import { hasPhotographs } from '../common/files.js';
import type { Messages } from '../common/messages.js';
import { bytesText, primitivesText } from '../common/numbers.js';

const photographsHint =
  'The desktop program trains scenes from photographs, and compares scenes with them: tureen view FOLDER.';

const stageText: Readonly<Record<LoadStage, string>> = {
  download: 'downloading', read: 'reading', prepare: 'preparing', upload: 'uploading to the graphics device', write: 'writing',
};

export class Loading {
  private readonly card = block('loading');
  private readonly name = block('loading-name');
  private readonly what = block('loading-what');
  private readonly progress = block('progress');
  private readonly bar = block('progress-bar');
  /** The loads, additions and steps that are not over. The viewer runs them in this order; the card shows the first. */
  private readonly pending: { readonly name: string; readonly ending: AbortController }[] = [];
  private preview = '';
  private progressNow: LoadProgress = { stage: 'download', fraction: null, loadedBytes: 0, totalBytes: null, deviceBytes: null };
  private readonly listeners: (() => void)[] = [];

  constructor(private readonly viewer: Viewer, private readonly messages: Messages) {
    button('cancel').addEventListener('click', () => this.cancel());
    viewer.on('progress', (progress) => this.show(progress));
    viewer.on('preview', (preview) => {
      this.preview = `; preview with ${primitivesText(preview)}`;
      this.show(this.progressNow);  // a stalled download would not update the text
    });
  }

  /** Calls `listener` when a load begins that replaces the scene, and before the scene is removed. */
  onBegin(listener: () => void): void { this.listeners.push(listener); }

  get busy(): boolean { return this.pending.length > 0; }

  /** Cancels the first of them. */
  cancel(): void { this.pending[0]?.ending.abort(); }

  /** Removes the scene, and cancels loads and additions. */
  clear(): void {
    for (const listener of this.listeners) listener();
    this.viewer.clear();
  }

  /** The scene; null if loading failed (the page then shows the error) or was cancelled. */
  load(source: SceneSource): Promise<SceneSummary | null> {
    return this.attempt(source).catch((error: unknown) => this.report(error, source));
  }

  /** The same, but rejects with the error for the caller. */
  attempt(source: SceneSource): Promise<SceneSummary> {
    this.messages.clearErrors();
    for (const listener of this.listeners) listener();
    for (const { ending } of this.pending) ending.abort();
    this.pending.length = 0;
    return this.run(nameOf(source), (signal) => this.viewer.load(source, { signal }));
  }

  /** The added layers; null if that failed (the page then shows the error) or was cancelled. */
  add(source: SceneSource): Promise<readonly SceneLayer[] | null> {
    return this.attemptToAdd(source).catch((error: unknown) => this.report(error, source));
  }

  /** The same, but rejects with the error for the caller. */
  attemptToAdd(source: SceneSource): Promise<readonly SceneLayer[]> {
    return this.run(nameOf(source), (signal) => this.viewer.addLayers(source, { signal }));
  }

  /** Writes a file with this name. The page shows the error. */
  async write(name: string, start: (signal: AbortSignal) => Promise<void>): Promise<void> {
    await this.run(name, start).catch((error: unknown) => this.messages.thrown(error));
  }

  /** Goes to a step, which may read sources again. Returns whether it succeeded; otherwise the page shows the error. */
  step(name: string, start: (signal: AbortSignal) => Promise<void>): Promise<boolean> {
    return this.run(name, start).then(() => true, (error: unknown) => {
      this.messages.thrown(error);
      return false;
    });
  }

  private report(error: unknown, source: SceneSource): null {
    this.messages.thrown(error, hasPhotographs(source) ? photographsHint : '');
    return null;
  }

  private async run<T>(name: string, start: (signal: AbortSignal) => Promise<T>): Promise<T> {
    const mine = { name, ending: new AbortController() };
    this.pending.push(mine);
    if (this.pending[0] === mine) this.begin(mine.name);
    try {
      return await start(mine.ending.signal);
    } finally {
      const at = this.pending.indexOf(mine);
      if (at >= 0) this.pending.splice(at, 1);
      const [next] = this.pending;
      if (!next) this.card.hidden = true;
      else if (at === 0) this.begin(next.name);
    }
  }

  private begin(name: string): void {
    this.preview = '';
    this.name.textContent = name;
    this.show({ stage: 'download', fraction: null, loadedBytes: 0, totalBytes: null, deviceBytes: null });
    this.card.hidden = false;
  }

  private show(progress: LoadProgress): void {
    this.progressNow = progress;
    const { stage, fraction, loadedBytes, totalBytes, deviceBytes } = progress;
    const bytes = stage !== 'download' || loadedBytes === 0 ? '' :
      totalBytes ? `, ${bytesText(loadedBytes)} of ${bytesText(totalBytes)}` : `, ${bytesText(loadedBytes)}`;
    const together = deviceBytes === null ? 0 : deviceBytes + (this.viewer.scene?.deviceBytes ?? 0);
    const forecast = deviceBytes === null ? '' : `, ${bytesText(deviceBytes)} of its memory, ${bytesText(together)} with the other layers`;
    const text = `${stageText[stage]}${bytes}${stage === 'upload' ? forecast : ''}${this.preview}`;
    this.what.textContent = text;
    this.progress.setAttribute('aria-valuetext', text);
    this.progress.classList.toggle('unknown', fraction === null);
    if (fraction === null) this.progress.removeAttribute('aria-valuenow');
    else this.progress.setAttribute('aria-valuenow', String(Math.round(fraction * 100)));
    this.bar.style.width = fraction === null ? '' : `${fraction * 100}%`;
  }
}
