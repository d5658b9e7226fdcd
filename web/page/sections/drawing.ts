// Drawing settings: background, resolution and smoothing; and the plan's sentences.

import type { Resolution, Viewer } from '../../viewer/types.js';
import { block, button, fillSentences, input, make, select } from '../../common/dom.js';
import { recall, remember } from '../memory.js';
import { colorFromHex, hexColor } from '../../common/numbers.js';

const resolutions: readonly { readonly key: string; readonly text: string; readonly value: Resolution }[] = [
  { key: '0.25', text: '0.25 × screen', value: 0.25 },
  { key: '0.5', text: '0.5 × screen', value: 0.5 },
  { key: '0.75', text: '0.75 × screen', value: 0.75 },
  { key: '1', text: 'screen', value: 1 },
  { key: '2', text: '2 × screen (4 samples per pixel)', value: 2 },
  { key: '30fps', text: 'automatic, for 30 frames per second', value: { targetFps: 30 } },
  { key: '60fps', text: 'automatic, for 60 frames per second', value: { targetFps: 60 } },
];

const keyOf = (resolution: Resolution) =>
  typeof resolution === 'number' ? String(resolution) : `${resolution.targetFps}fps`;

export class DrawingSection {
  private readonly background = input('background');
  private readonly resolution = select('resolution');
  private readonly smooth = input('smooth');

  constructor(private readonly viewer: Viewer) {
    this.resolution.append(...resolutions.map(({ key, text }) => make('option', { value: key }, text)));
    const kept = resolutions.find(({ key }) => key === recall('resolution'));
    if (kept) viewer.resolution = kept.value;
    this.resolution.addEventListener('change', () => {
      const chosen = resolutions.find(({ key }) => key === this.resolution.value);
      if (chosen) viewer.resolution = chosen.value;
      remember('resolution', this.resolution.value);
    });
    this.smooth.addEventListener('change', () => {
      viewer.smoothAtRest = this.smooth.checked;
      remember('smooth', this.smooth.checked);
    });
    // While the browser's dialog is open, all changes are one step.
    this.background.addEventListener('change', () => { viewer.holding = false; });
    this.background.addEventListener('input', () => {
      viewer.holding = true;
      viewer.background = colorFromHex(this.background.value) ?? viewer.background;
    });
    button('own-background').addEventListener('click', () => {
      if (viewer.scene) viewer.background = viewer.scene.background;
      this.update();
    });
    viewer.on('scene', () => this.update());
    viewer.on('steps', () => { this.background.value = hexColor(viewer.background); });
    this.update();
  }

  private update(): void {
    this.background.value = hexColor(this.viewer.background);
    this.resolution.value = keyOf(this.viewer.resolution);
    this.smooth.checked = this.viewer.smoothAtRest;
    const plan = this.viewer.scene?.plan ?? [];
    fillSentences(block('plan'), plan);
    block('plan-part').hidden = plan.length === 0;
  }
}
