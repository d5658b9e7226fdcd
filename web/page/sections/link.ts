// A link to what is seen: scene and camera, as far as a link can carry them.

import type { Viewer } from '../../viewer/types.js';
import type { AddressBar } from '../address_bar.js';
import { block, button, input } from '../dom.js';
import type { Openings } from '../openings.js';

export class LinkSection {
  private readonly field = input('link');

  constructor(private readonly viewer: Viewer, private readonly bar: AddressBar, private readonly openings: Openings,
              private readonly tell: (sentence: string) => void) {
    button('copy-link').addEventListener('click', () => void this.copy());
    button('quick-link').addEventListener('click', () => void this.copy());
    this.field.addEventListener('focus', () => {
      this.update();
      this.field.select();
    });
    viewer.on('view', () => this.update());
    this.update();
  }

  update(): void {
    const { viewer, bar, openings } = this;
    const origin = openings.origin;
    const scene = origin?.kind === 'address' ? origin.address : null;
    this.field.value = bar.link(scene, viewer.scene ? viewer.getView() : null, viewer.shownLook);
    block('link-hint').textContent = this.hint();
  }

  async copy(): Promise<void> {
    this.update();
    if (!this.viewer.scene) return this.tell('There is nothing to link to yet.');
    try {
      await navigator.clipboard.writeText(this.field.value);
    } catch {  // no permission, or a page that is neither https nor localhost
      this.field.closest('details')!.open = true;
      this.field.select();
      return this.tell(
        'The browser does not let the page copy; the link is selected in the panel, under “Image and link”.');
    }
    this.tell(`The link is copied. ${this.hint()}`);
  }

  /** What it carries and what not. */
  private hint(): string {
    const origin = this.openings.origin;
    if (origin?.kind === 'files')
      return 'The scene came from a file of yours, which a link cannot carry: it has the camera alone, for ' +
        'who opens the same file.';
    if (origin?.kind === 'page' && location.protocol === 'file:')
      return 'It leads to this file on this computer; send the file along.';
    return origin ? 'It opens this scene from here.' : '';
  }
}
