// The list of saved views for each scene.

import type { Viewer } from '../../viewer/types.js';
import { block, byId, icon, input, make } from '../../common/dom.js';
import { SavedViews } from '../saved_views.js';

export class SavedSection {
  private views = new SavedViews('');
  private readonly list = block('saved');

  constructor(private readonly viewer: Viewer, private readonly tell: (sentence: string) => void) {
    byId('save-view', HTMLFormElement).addEventListener('submit', (event) => {
      event.preventDefault();
      this.save(input('view-name').value);
      input('view-name').value = '';
    });
    this.show();
  }

  /** Shows the views of another scene, identified by `key`. */
  follow(key: string): void {
    this.views = new SavedViews(key);
    this.show();
  }

  save(name = ''): void {
    if (!this.viewer.scene) return this.tell('There is no view to save: open a scene first.');
    this.tell(`Saved as “${this.views.save(name, this.viewer.getView())}”.`);
    this.show();
  }

  private show(): void {
    this.list.replaceChildren(...this.views.list().map(({ name, pose }) => {
      const go = make('button', { type: 'button', class: 'plain go' }, name);
      const remove =
        make('button', { type: 'button', class: 'plain', 'aria-label': `Delete the view ${name}` }, icon('close'));
      go.addEventListener('click', () => this.viewer.setView(pose, { glide: true }));
      remove.addEventListener('click', () => {
        this.views.remove(name);
        this.show();
        input('view-name').focus();
      });
      return make('li', {}, go, remove);
    }));
    const hint = block('saved-hint');
    hint.hidden = this.views.lasting;
    hint.textContent = 'This browser stores nothing for this page: saved views are lost when it is closed.';
  }
}
