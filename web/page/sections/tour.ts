// Turntables, and flights along the recorded cameras.

import type { Tour, Viewer } from '../../viewer/types.js';
import { button } from '../../common/dom.js';

const buttons: Readonly<Record<Tour, string>> = { turntable: 'play-turntable', cameras: 'play-cameras' };

export class TourSection {
  constructor(private readonly viewer: Viewer, private readonly failed: (what: unknown) => void) {
    for (const tour of ['turntable', 'cameras'] as const) button(buttons[tour]).addEventListener('click', () => this.toggle(tour));
    viewer.on('tour', () => this.update());
    viewer.on('scene', () => this.update());
    this.update();
  }

  toggle(tour: Tour): void {
    const { viewer } = this, was = viewer.playing;
    try {
      viewer.stop();
      if (was !== tour) viewer.play(tour);
    } catch (error) {
      this.failed(error);
    }
  }

  private update(): void {
    for (const tour of ['turntable', 'cameras'] as const)
      button(buttons[tour]).setAttribute('aria-pressed', String(this.viewer.playing === tour));
    button(buttons.cameras).hidden = !this.viewer.scene?.cameras.length;
  }
}
