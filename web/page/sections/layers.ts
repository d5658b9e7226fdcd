// The layers of a scene with several: visibility, order, removal, and the place of the selected one.

import type { Placement, SceneLayer, Vec3, Viewer } from '../../viewer/types.js';
import { block, icon, input, make } from '../../common/dom.js';
import { bytesText, degreesPerRadian, plainNumber, primitivesText } from '../../common/numbers.js';

const axes = ['x', 'y', 'z'] as const;
/** Decimals of the shown numbers: enough for a place on the screen, few enough to read. */
const decimals = 6;

const replaced = (vector: Vec3, axis: number, value: number): Vec3 =>
  [axis === 0 ? value : vector[0], axis === 1 ? value : vector[1], axis === 2 ? value : vector[2]];

export class LayersSection {
  private readonly part = block('layers-part');
  private readonly list = block('layers');
  private readonly scale = input('layer-scale');
  private readonly mirror = input('layer-mirror');
  private selected = 0;

  constructor(private readonly viewer: Viewer, private readonly tell: (sentence: string) => void,
              private readonly failed: (what: unknown) => void) {
    for (const [axis, letter] of axes.entries()) {
      this.onNumber(`layer-position-${letter}`, (value, now) => ({ position: replaced(now.position, axis, value) }));
      this.onNumber(`layer-rotation-${letter}`, (value, now) =>
        ({ rotation: replaced(now.rotation, axis, value / degreesPerRadian) }));
    }
    this.onNumber('layer-scale', (scale) => ({ scale }));
    this.mirror.addEventListener('change', () => this.change({ mirror: this.mirror.checked }));
    viewer.on('layers', () => this.update());
    this.update();
  }

  private onNumber(id: string, change: (value: number, now: Placement) => Partial<Placement>): void {
    const field = input(id);
    field.addEventListener('change', () => {
      const layer = this.viewer.layers[this.selected];
      if (layer && Number.isFinite(field.valueAsNumber)) this.change(change(field.valueAsNumber, layer.placement));
      else this.update();  // an empty or unreadable number: the present one returns
    });
  }

  /** Changes the place of the selected layer. */
  private change(part: Partial<Placement>): void {
    const layer = this.viewer.layers[this.selected];
    if (!layer) return;
    try {
      this.viewer.setLayer(this.selected, { transform: { ...layer.placement, ...part } });
    } catch (error) {
      this.failed(error);
      this.update();
    }
  }

  private select(index: number): void {
    this.selected = index;
    this.update();
  }

  private async move(from: number, to: number): Promise<void> {
    const { name } = this.viewer.layers[from]!;
    if (this.selected === from) this.selected = to;
    else if (this.selected === to) this.selected = from;
    if (await this.attempt(() => this.viewer.moveLayer(from, to)))
      this.tell(`${name} is now layer ${to + 1} of ${this.viewer.layers.length}.`);
  }

  private async remove(index: number): Promise<void> {
    const { name } = this.viewer.layers[index]!;
    if (this.selected > index) --this.selected;
    if (await this.attempt(() => this.viewer.removeLayer(index))) this.tell(`${name} was removed.`);
    if (document.activeElement === document.body) this.viewer.canvas.focus();  // the section is hidden now
  }

  /** Returns whether it succeeded; otherwise the page shows the error. */
  private async attempt(what: () => Promise<void>): Promise<boolean> {
    try {
      await what();
      return true;
    } catch (error) {
      this.failed(error);
      return false;
    }
  }

  private update(): void {
    const { layers } = this.viewer;
    this.part.hidden = layers.length < 2;
    this.selected = Math.max(Math.min(this.selected, layers.length - 1), 0);
    this.fill(this.part.hidden ? [] : layers);
    const bytes = layers.reduce((sum, layer) => sum + layer.deviceBytes, 0);
    block('layers-memory').textContent = `Together ${bytesText(bytes)} of GPU memory. Where layers meet at the same depth, the upper one is visible.`;
    this.showPlace(layers[this.selected]);
  }

  /** Fills the list; the focus stays on the same control of the same layer, or near it. */
  private fill(layers: readonly SceneLayer[]): void {
    const focused = document.activeElement instanceof HTMLElement && this.list.contains(document.activeElement) ?
      document.activeElement.dataset.control ?? null : null;
    const name = focused && focused.slice(focused.indexOf(' ') + 1);
    this.list.replaceChildren(...layers.map((layer, index) => this.row(layer, index, layers.length)));
    if (focused === null) return;
    const controls = [...this.list.querySelectorAll<HTMLElement>('[data-control]')];
    const same = controls.find((control) => control.dataset.control === focused && !control.matches(':disabled'));
    (same ?? controls.find((control) => control.dataset.control === `select ${name}`) ??
      controls.find((control) => control.matches('[aria-pressed=true]')))?.focus();
  }

  private row({ name, triangles, splats, visible, deviceBytes }: SceneLayer, index: number, count: number): HTMLElement {
    const shown = make('input', { type: 'checkbox', 'aria-label': `Show ${name}`, checked: visible, 'data-control': `show ${name}` });
    shown.addEventListener('change', () => this.viewer.setLayer(index, { visible: shown.checked }));
    const choose = make('button', {
      type: 'button', class: 'plain go', 'aria-pressed': String(index === this.selected), 'data-control': `select ${name}`,
    }, make('span', {}, name), make('small', {}, `${primitivesText({ triangles, splats })} · ${bytesText(deviceBytes)}`));
    choose.addEventListener('click', () => this.select(index));
    const action = (control: string, symbol: string, label: string, disabled: boolean, run: () => void) => {
      const made = make('button', {
        type: 'button', class: 'plain', 'aria-label': `${label} ${name}`, title: label, disabled, 'data-control': `${control} ${name}`,
      }, icon(symbol));
      made.addEventListener('click', run);
      return made;
    };
    return make('li', {}, make('label', { class: 'check' }, shown), choose,
                action('up', 'up', 'Move up', index === 0, () => void this.move(index, index - 1)),
                action('down', 'down', 'Move down', index === count - 1, () => void this.move(index, index + 1)),
                action('remove', 'close', 'Remove', false, () => void this.remove(index)));
  }

  private showPlace(layer: SceneLayer | undefined): void {
    if (!layer) return;
    const { position, rotation, scale, mirror } = layer.placement;
    block('layer-name').textContent = `Place of ${layer.name}`;
    for (const [axis, letter] of axes.entries()) {
      input(`layer-position-${letter}`).value = plainNumber(position[axis]!, decimals);
      input(`layer-rotation-${letter}`).value = plainNumber(rotation[axis]! * degreesPerRadian, decimals);
    }
    this.scale.value = plainNumber(scale, decimals);
    this.mirror.checked = mirror;
  }
}
