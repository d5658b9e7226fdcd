// Undo, Redo, and the list of steps: a click goes to one.

import type { Viewer } from '../../viewer/types.js';
import { block, button, make } from '../../common/dom.js';
import type { Loading } from '../loading.js';

export class StepsSection {
  private readonly undoButton = button('undo');
  private readonly redoButton = button('redo');
  private readonly list = block('steps');

  constructor(private readonly viewer: Viewer, private readonly loading: Loading, private readonly tell: (sentence: string) => void) {
    this.undoButton.addEventListener('click', () => void this.go('undo'));
    this.redoButton.addEventListener('click', () => void this.go('redo'));
    viewer.on('steps', () => this.update());
    this.update();
  }

  async go(what: 'undo' | 'redo'): Promise<void> {
    const { names, position } = this.viewer.steps, name = names[what === 'undo' ? position - 1 : position];
    if (name === undefined) return this.tell(`There is nothing to ${what}.`);
    if (await this.loading.step(name, (signal) => this.viewer[what]({ signal })))
      this.tell(`${what === 'undo' ? 'Undone' : 'Redone'}: ${name}`);
  }

  private update(): void {
    const { names, position } = this.viewer.steps;
    this.undoButton.disabled = position === 0;
    this.redoButton.disabled = position === names.length;
    block('steps-part').hidden = names.length === 0;
    const hadFocus = this.list.contains(document.activeElement);
    this.list.replaceChildren(...['Before the first step', ...names].map((name, index) => {
      const go = make('button', {
        type: 'button', class: `plain go${index > position ? ' undone' : ''}`, 'aria-current': index === position ? 'step' : null,
      }, name);
      go.addEventListener('click', () => void this.loading.step(name, (signal) => this.viewer.goToStep(index, { signal })));
      return make('li', {}, go);
    }));
    const current = this.list.children[position]!;
    if (hadFocus) current.querySelector('button')!.focus();
    // Scrolls only the list, not the panel around it.
    this.list.scrollTop = current.getBoundingClientRect().top - this.list.children[0]!.getBoundingClientRect().top - this.list.clientHeight / 2;
  }
}
