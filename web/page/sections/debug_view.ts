// The debug view instead of the final colours, and its legend.

import type { DebugViewChoice, Viewer } from '../../viewer/types.js';
import { block, input, make, select } from '../../common/dom.js';
import { hexColor } from '../../common/numbers.js';

export class DebugViewSection {
  private readonly list = select('debug-view');
  private readonly first = input('feature-first');
  private readonly count = input('feature-count');

  constructor(private readonly viewer: Viewer, private readonly failed: (what: unknown) => void,
              private readonly shown: () => void) {
    this.list.addEventListener('change', () => void this.show(this.list.value));
    for (const number of [this.first, this.count])
      number.addEventListener('change', () => void this.show('features'));
    viewer.on('scene', () => this.fill());
    viewer.on('view', () => this.update());  // the legend of depth follows the view
    this.fill();
  }

  async show(name: string): Promise<void> {
    const features = { first: this.first.valueAsNumber || 0, count: this.count.valueAsNumber || 1 };
    try {
      await (name === 'features' ? this.viewer.show(name, features) : this.viewer.show(name));
    } catch (error) {
      this.failed(error);
    }
    this.update();
    this.shown();
  }

  /** Selects the next debug view that the scene supports. */
  next(): void {
    const there = this.supported();
    if (there.length === 0) return;
    const now = there.findIndex((choice) => choice.name === this.viewer.debugView);
    void this.show(there[(now + 1) % there.length]!.name);
  }

  update(): void {
    const name = this.viewer.debugView;
    this.list.value = name;
    const choice = this.viewer.scene?.debugViews.find((one) => one.name === name);
    block('debug-view-meaning').textContent = choice?.meaning ?? '';
    const features = this.viewer.scene?.featureCount ?? 0;
    block('features').hidden = name !== 'features' || features < 2;
    this.first.max = String(Math.max(features - 1, 0));
    this.count.max = String(Math.min(features, 3));
    this.fillLegend(choice?.title ?? '');
  }

  private fill(): void {
    const choices = this.supported();
    this.list.disabled = choices.length === 0;
    this.list.replaceChildren(...choices.map(({ name, title }) => make('option', { value: name }, title)));
    this.update();
  }

  private supported(): readonly DebugViewChoice[] {
    return (this.viewer.scene?.debugViews ?? []).filter(({ missing }) => missing === null);
  }

  private fillLegend(title: string): void {
    const legend = block('legend'), entries = this.viewer.legend;
    legend.hidden = entries.length === 0;
    legend.replaceChildren(make('strong', {}, title), make('ul', {}, ...entries.map(({ color, text }) => {
      const patch = make('span', { class: 'patch' });
      patch.style.backgroundColor = hexColor(color);
      return make('li', {}, patch, text);
    })));
  }
}
