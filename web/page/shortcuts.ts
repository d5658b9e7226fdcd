// Keys of the page. They are the desktop window's (viewer/input/shortcuts.cpp) where a browser leaves them
// free. Keys that move the view belong to the canvas (viewer/controls.ts) and come first.

import { block, byId, input, make, takesText } from './dom.js';
import { recall, remember } from './memory.js';

export interface Shortcut {
  /** As KeyboardEvent.key has it, letters small. */
  readonly key: string;
  /** Null: it is listed otherwise. */
  readonly meaning: string | null;
  run(): void;
}

type Row = readonly [string, string];

const pointerRows: readonly Row[] = [
  ['Drag', 'turns the scene, or the head when flying'],
  ['Right drag, Shift drag', 'moves the scene along'],
  ['Wheel', 'nearer and farther; flying: faster and slower'],
  ['Double click', 'brings a point to the centre'],
];
const touchRows: readonly Row[] = [
  ['One finger', 'turns'], ['Two fingers', 'move and pinch'], ['Two taps', 'bring a point to the centre'],
];
const movingRows: readonly Row[] = [
  ['W A S D, Q E', 'fly; Shift: fast, Alt: slow'], ['Arrows', 'turn, with Shift move'], ['+ −', 'nearer, farther'],
  ['1 to 9', 'front, back, sides, top, bottom, corners'],
];

/** Keys as they stand on a keyboard. */
const capOf = (key: string) => (key.length === 1 ? key.toUpperCase() : key);

function table(title: string, rows: readonly Row[], cap: (text: string) => Node | string): HTMLElement {
  return make('section', {}, make('h3', {}, title), make('dl', { class: 'keys' }, ...rows.map(([what, meaning]) =>
    make('div', {}, make('dt', {}, cap(what)), make('dd', {}, meaning)))));
}

/** Single keys are not for everyone: who speaks to the computer sets them off by mistake. So they can
 *  be kept to the image. */
export class Shortcuts {
  private readonly help = byId('help', HTMLDialogElement);
  private readonly everywhere = input('keys-everywhere');

  constructor(private readonly canvas: HTMLCanvasElement, private readonly shortcuts: readonly Shortcut[]) {
    const rows = shortcuts.flatMap(({ key, meaning }): Row[] => (meaning === null ? [] : [[capOf(key), meaning]]));
    const gesture = (text: string) => text, cap = (text: string) => make('kbd', {}, text);
    block('help-tables').append(table('Pointer', pointerRows, gesture), table('Touch', touchRows, gesture),
                                table('Moving', movingRows, cap), table('Keys', rows, cap));
    block('open-help').addEventListener('click', () => this.showHelp());
    this.everywhere.checked = recall('keys') !== false;
    this.everywhere.addEventListener('change', () => remember('keys', this.everywhere.checked));
    document.addEventListener('keydown', (event) => this.press(event));
  }

  showHelp(): void {
    if (!this.help.open) this.help.showModal();
  }

  private press(event: KeyboardEvent): void {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || event.repeat) return;
    if (takesText(event.target) || document.querySelector('dialog[open]')) return;
    if (!this.everywhere.checked && event.target !== this.canvas) return;
    // A list that has the focus finds its entries by their first letters.
    if (event.target instanceof HTMLSelectElement) return;
    const digit = event.shiftKey ? null : /^(?:Digit|Numpad)(\d)$/.exec(event.code);  // on any layout
    const key = digit ? digit[1]! : event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const shortcut = this.shortcuts.find((one) => one.key === key);
    if (!shortcut) return;
    event.preventDefault();
    shortcut.run();
  }
}
