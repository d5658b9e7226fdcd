// The list of available scenes with check boxes: from the gallery, from addresses, and from files that
// were picked or dropped.

import { attachPicker, block, button, input, make } from '../common/dom.js';
import { sourcesOfDropped, sourcesOfPicked } from '../common/files.js';
import { readModels } from '../common/gallery.js';
import { nameOf } from '../viewer/addresses.js';
import type { Messages } from '../common/messages.js';
import { bytesText, trianglesText } from '../common/numbers.js';
import type { SceneSource } from '../viewer/types.js';

export class SceneList {
  private readonly list = block('scenes');
  private readonly rows: { source: SceneSource; box: HTMLInputElement }[] = [];

  constructor(private readonly messages: Messages) {
    button('add-address').addEventListener('click', () => this.addTyped());
    input('address').addEventListener('keydown', (event) => {
      if (event.key !== 'Enter') return;
      event.preventDefault();  // Enter would start the measurement
      this.addTyped();
    });
    for (const kind of ['files', 'folder'])
      attachPicker(`choose-${kind}`, kind, (files) => void this.take(async () => sourcesOfPicked(files)));
    this.attachDrop();
  }

  /** Adds the scenes of the address and of the gallery. The first gallery scene is chosen if the address has none. */
  async fill(addresses: readonly string[]): Promise<void> {
    for (const address of addresses) this.add({ url: address });
    for (const { name, url, triangles, bytes } of await readModels()) {
      if (addresses.includes(url)) continue;
      const facts = [triangles === null ? '' : trianglesText(triangles), bytes === null ? '' : bytesText(bytes)];
      this.add({ url }, { name, facts: facts.filter(Boolean).join(' · '), chosen: this.rows.length === 0 });
    }
  }

  get chosen(): readonly SceneSource[] {
    return this.rows.filter(({ box }) => box.checked).map(({ source }) => source);
  }

  private add(source: SceneSource, { name = nameOf(source), facts = 'url' in source ? source.url : '', chosen = true } = {}): void {
    const box = make('input', { type: 'checkbox' });
    box.checked = chosen;
    this.list.append(make('li', {}, make('label', { class: 'check' }, box,
      make('span', {}, name, ...(facts && facts !== name ? [make('small', {}, facts)] : [])))));
    this.rows.push({ source, box });
  }

  private addTyped(): void {
    const field = input('address'), address = field.value.trim();
    if (!address) return;
    field.value = '';
    this.add({ url: address });
  }

  private attachDrop(): void {
    const sign = block('drop-here');
    const carriesFiles = (event: DragEvent) => event.dataTransfer?.types.includes('Files') ?? false;
    window.addEventListener('dragover', (event) => {
      if (!carriesFiles(event)) return;
      event.preventDefault();
      sign.hidden = false;
    });
    window.addEventListener('dragleave', (event) => { if (!event.relatedTarget) sign.hidden = true; });
    window.addEventListener('drop', (event) => {
      sign.hidden = true;
      if (!carriesFiles(event)) return;
      event.preventDefault();
      const dropped = sourcesOfDropped(event.dataTransfer!);  // dataTransfer is empty after the event
      void this.take(() => dropped);
    });
  }

  private async take(read: () => Promise<readonly SceneSource[]>): Promise<void> {
    try {
      for (const source of await read()) this.add(source);
    } catch (error) {
      this.messages.thrown(error);
    }
  }
}
