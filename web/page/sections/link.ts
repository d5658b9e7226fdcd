// A link to the current scene and view, as far as a link can contain them.

import type { Viewer } from '../../viewer/types.js';
import type { AddressBar } from '../address_bar.js';
import { block, button, input } from '../../common/dom.js';
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
    viewer.on('layers', () => this.update());
    this.update();
  }

  update(): void {
    const { viewer, bar, openings } = this;
    this.field.value = bar.link(openings.addresses, viewer.scene ? viewer.getView() : null, viewer.debugView,
                                openings.layersText);
    block('link-hint').textContent = this.hint();
  }

  async copy(): Promise<void> {
    this.update();
    if (!this.viewer.scene) return this.tell('There is no view to link to: open a scene first.');
    try {
      await navigator.clipboard.writeText(this.field.value);
    } catch {  // no permission, or a page that is neither https nor localhost
      this.field.closest('details')!.open = true;
      this.field.select();
      return this.tell(
        'The browser does not allow the page to copy. Copy the selected link in the panel under “Image and link”.');
    }
    this.tell(`Link copied. ${this.hint()}`);
  }

  /** The contents and limits of the link. */
  private hint(): string {
    const origin = this.openings.origin;
    if (this.openings.lacksScenes && this.openings.addresses.length > 0)
      return 'The link lacks the layers from local files.';
    if (origin?.kind === 'files' || this.openings.lacksScenes)
      return 'The link contains only the camera, because the scene is a local file. Open the same file to use ' +
        'the link. To send the scene, write it as one page: tureen convert SCENE scene.html';
    if (origin?.kind === 'page' && location.protocol === 'file:')
      return 'The link points to this file on this computer: send the file together with the link.';
    if (this.openings.addresses.length > 1) return 'The link opens these scenes with this view.';
    return origin ? 'The link opens this scene with this view.' : '';
  }
}
