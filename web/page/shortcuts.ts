// Keys of the page: the same as in the desktop window (viewer/shortcuts.cpp), unless browsers use
// them. Keys that move the view belong to the canvas (viewer/controls.ts) and have priority.

import { block, byId, input, make, takesText } from '../common/dom.js';
import { recall, remember } from './memory.js';

export interface Shortcut {
  /** A value of KeyboardEvent.key, in lower case; with "ctrl+" or "ctrl+shift+" before it for both on any system. */
  readonly key: string;
  /** The text in the help; null if another row lists the key. */
  readonly meaning: string | null;
  run(): void;
}

type Row = readonly [string, string];

const pointerRows: readonly Row[] = [
  ['Drag', 'turn the scene; when flying, turn the camera'],
  ['Right drag, Shift drag', 'move the scene'],
  ['Wheel', 'zoom; when flying, change the speed'],
  ['Double click', 'centre a point'],
];
const touchRows: readonly Row[] = [
  ['One finger', 'turn'], ['Two fingers', 'move and zoom'], ['Two taps', 'centre a point'],
];
const movingRows: readonly Row[] = [
  ['W A S D, Q E', 'fly; Shift: fast, Alt: slow'], ['Arrows', 'turn; with Shift, move'], ['+ −', 'zoom in, zoom out'],
  ['1 to 9', 'front, back, sides, top, bottom, corners'],
];

/** The label of a key: "Ctrl+Z". */
const capOf = (key: string) => key.split('+').map((part) => part[0]!.toUpperCase() + part.slice(1)).join('+');

function table(title: string, rows: readonly Row[], cap: (text: string) => Node | string): HTMLElement {
  return make('section', {}, make('h3', {}, title), make('dl', { class: 'keys' }, ...rows.map(([what, meaning]) =>
    make('div', {}, make('dt', {}, cap(what)), make('dd', {}, meaning)))));
}

/** The page's keys and their help. Speech input may press single keys by mistake, so the user can
 *  restrict them to the image. */
export class Shortcuts {
  private readonly help = byId('help', HTMLDialogElement);
  private readonly everywhere = input('keys-everywhere');

  constructor(private readonly canvas: HTMLCanvasElement, private readonly shortcuts: readonly Shortcut[]) {
    const rows = shortcuts.flatMap(({ key, meaning }): Row[] => (meaning === null ? [] : [[capOf(key), meaning]]));
    const gesture = (text: string) => text, cap = (text: string) => make('kbd', {}, text);
    const gestures = [table('Pointer', pointerRows, gesture), table('Touch', touchRows, gesture)];
    if (matchMedia('(pointer: coarse)').matches) gestures.reverse();
    block('help-tables').append(...gestures, table('Moving', movingRows, cap), table('Keys', rows, cap));
    block('open-help').addEventListener('click', () => this.showHelp());
    this.everywhere.checked = recall('keys') !== false;
    this.everywhere.addEventListener('change', () => remember('keys', this.everywhere.checked));
    document.addEventListener('keydown', (event) => this.press(event));
  }

  showHelp(): void {
    if (!this.help.open) this.help.showModal();
  }

  private press(event: KeyboardEvent): void {
    if (event.defaultPrevented || event.altKey || event.repeat) return;
    if (takesText(event.target) || document.querySelector('dialog[open]')) return;
    const control = event.ctrlKey || event.metaKey;
    if (!control && !this.everywhere.checked && event.target !== this.canvas) return;
    // A focused list uses letters to find its entries.
    if (!control && event.target instanceof HTMLSelectElement) return;
    const digit = event.shiftKey ? null : /^(?:Digit|Numpad)(\d)$/.exec(event.code);  // on any layout
    const plain = digit ? digit[1]! : event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const key = (control ? `ctrl+${event.shiftKey ? 'shift+' : ''}` : '') + plain;
    const shortcut = this.shortcuts.find((one) => one.key === key);
    if (!shortcut) return;
    event.preventDefault();
    shortcut.run();
  }
}
