// The list of recorded cameras from the scene's file.

import type { Viewer } from '../../viewer/types.js';
import { block, button, make, select } from '../../common/dom.js';

export class CamerasSection {
  private readonly list = select('cameras');

  constructor(private readonly viewer: Viewer, private readonly tell: (sentence: string) => void) {
    this.list.addEventListener('change', () => {
      if (this.list.value !== '') viewer.showCamera(Number(this.list.value));
    });
    button('camera-before').addEventListener('click', () => this.step(-1));
    button('camera-next').addEventListener('click', () => this.step(1));
    viewer.on('scene', (scene) => {
      const cameras = scene?.cameras ?? [];
      block('cameras-part').hidden = cameras.length === 0;
      this.list.replaceChildren(
        make('option', { value: '' }, 'none'),
        ...cameras.map(({ name, width, height }, index) =>
          make('option', { value: index }, `${name || `camera ${index + 1}`}, ${width} × ${height}`)));
    });
  }

  /** Selects the next or previous camera, cyclically. */
  step(by: 1 | -1): void {
    const count = this.viewer.scene?.cameras.length ?? 0;
    if (count === 0) return this.tell('The scene has no recorded cameras.');
    const now = this.list.value === '' ? (by > 0 ? -1 : 0) : Number(this.list.value);
    const next = (now + by + count) % count;
    this.list.value = String(next);
    this.viewer.showCamera(next);
  }
}
