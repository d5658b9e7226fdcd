// The card for opening scenes from files, a folder, an address or the gallery. It covers the image while
// there is no scene, and on request.

import type { Viewer } from '../viewer/types.js';
import { attachPicker, block, byId, button, input } from '../common/dom.js';
import { sourcesOfDropped, sourcesOfPicked } from '../common/files.js';
import { fillGallery } from '../common/gallery.js';
import type { Loading } from './loading.js';
import type { Messages } from '../common/messages.js';
import type { Openings } from './openings.js';

export class Start {
  private readonly card = block('start');
  private readonly opener = button('open-start');
  private readonly closer = button('close-start');

  constructor(private readonly viewer: Viewer, private readonly openings: Openings,
              private readonly loading: Loading, private readonly messages: Messages) {
    this.opener.addEventListener('click', () => this.toggle());
    this.closer.addEventListener('click', () => this.close());
    window.addEventListener('keydown', (event) => {
      if (event.key === 'Escape' && !event.defaultPrevented && !document.querySelector('dialog[open]')) this.close();
    });
    for (const kind of ['files', 'folder'])
      attachPicker(`choose-${kind}`, kind, (files) => void this.leaveFor(this.pick(files)));
    if (!('webkitdirectory' in input('folder'))) button('choose-folder').hidden = true;
    byId('address-form', HTMLFormElement).addEventListener('submit', (event) => {
      event.preventDefault();
      const address = input('address').value.trim();
      if (address) void this.leaveFor(this.openings.openAddresses([address]));
    });
    void fillGallery((address, view) => void this.leaveFor(this.openings.openAddresses([address], view)));
    viewer.on('preview', () => this.show(false));
    viewer.on('scene', () => this.update());
  }

  /** Opens or closes the card and moves the focus. */
  toggle(): void {
    if (!this.card.hidden) return this.close();
    this.show(true);
    block('start-title').focus();
  }

  /** Closes the card, unless there is no scene. */
  close(): void {
    if (this.card.hidden || !this.viewer.scene) return;
    this.show(false);
    this.opener.focus();
  }

  /** Opens the card if there is no scene and no load is running; otherwise closes it. */
  update(): void { this.show(!this.viewer.scene && !this.loading.busy); }

  private show(open: boolean): void {
    this.card.hidden = !open;
    this.closer.hidden = !this.viewer.scene;
    this.opener.setAttribute('aria-expanded', String(open));
  }

  private async pick(list: FileList): Promise<boolean> { return this.openings.openFiles(sourcesOfPicked(list)); }

  /** Closes the card while a scene opens; opens it again if that fails. */
  private async leaveFor(opening: Promise<boolean>): Promise<void> {
    const held = this.card.contains(document.activeElement);
    this.show(false);
    if (held) this.viewer.canvas.focus();
    const opened = await opening.catch((error: unknown) => {
      this.messages.thrown(error);
      return false;
    });
    if (!opened) this.update();
    else if (held && document.activeElement === document.body) this.viewer.canvas.focus();  // the canvas was invisible before
  }

  /** Opens files that are dropped anywhere on the page; adds them to the scene if there is one. */
  attachDrop(): void {
    const sign = block('drop-here'), text = sign.firstElementChild!;
    const carriesFiles = (event: DragEvent) => event.dataTransfer?.types.includes('Files') ?? false;
    let depth = 0;  // number of elements that the pointer has entered and not left
    const over = (change: number) => {
      depth = Math.max(depth + change, 0);
      sign.hidden = depth === 0;
      text.textContent = this.viewer.scene ? 'Drop to add' : 'Drop to open';
    };
    window.addEventListener('dragenter', (event) => { if (carriesFiles(event)) over(1); });
    window.addEventListener('dragleave', (event) => { if (carriesFiles(event)) over(-1); });
    window.addEventListener('dragover', (event) => { if (carriesFiles(event)) event.preventDefault(); });
    window.addEventListener('drop', (event) => {
      if (!carriesFiles(event) || !event.dataTransfer) return;
      event.preventDefault();
      over(-depth);
      void this.leaveFor(this.drop(event.dataTransfer));
    });
  }

  private async drop(transfer: DataTransfer): Promise<boolean> {
    const adds = this.viewer.scene !== null, sources = await sourcesOfDropped(transfer);
    return adds ? this.openings.addFiles(sources) : this.openings.openFiles(sources);
  }
}
