// The view of the scene: drag mode, named views, up axis and angle.

import { namedViews, type NamedView, type NavigationMode, type Vec3, type Viewer } from '../../viewer/types.js';
import { block, button, input, make, select } from '../../common/dom.js';
import { remember } from '../memory.js';
import { degreesPerRadian } from '../../common/numbers.js';

const viewTitles: Readonly<Record<NamedView, string>> = {
  front: 'Front', back: 'Back', left: 'Left', right: 'Right', top: 'Top', bottom: 'Bottom',
  'three-quarter': 'Corner', 'three-quarter-left': 'Corner left', 'three-quarter-back': 'Corner back',
};

/** In the order of the key U: most probable first. */
const axes: readonly { readonly name: string; readonly axis: Vec3 }[] = [
  { name: 'y', axis: [0, 1, 0] }, { name: 'z', axis: [0, 0, 1] }, { name: 'x', axis: [1, 0, 0] },
  { name: '-y', axis: [0, -1, 0] }, { name: '-z', axis: [0, 0, -1] }, { name: '-x', axis: [-1, 0, 0] },
];

/** Whether a direction is within 2.6 degrees of an axis of length 1: an up axis from cameras is slightly inexact. */
const isAxis = (direction: Vec3, axis: Vec3) =>
  direction[0] * axis[0] + direction[1] * axis[1] + direction[2] * axis[2] > 0.999 * Math.hypot(...direction);

export class ViewsSection {
  private readonly modes = [...document.querySelectorAll<HTMLInputElement>('input[name=mode]')];
  private readonly up = select('up');
  private readonly fov = input('fov');

  constructor(private readonly viewer: Viewer, private readonly tell: (sentence: string) => void) {
    for (const mode of this.modes)
      mode.addEventListener('change', () => this.setMode(mode.value as NavigationMode));
    block('named-views').append(...namedViews.map((view, index) => {
      const look = make('button', { type: 'button', title: `${viewTitles[view]} (${index + 1})` }, viewTitles[view]);
      look.addEventListener('click', () => this.lookFrom(view));
      return look;
    }));
    button('frame').addEventListener('click', () => this.frame());
    button('home').addEventListener('click', () => this.first());
    this.up.append(...axes.map(({ name }, index) => make('option', { value: index }, name)),
                   make('option', { value: 'own', hidden: true }, 'from the cameras'));
    this.up.addEventListener('change', () => {
      const chosen = axes[Number(this.up.value)];
      if (chosen) viewer.setUp(chosen.axis);
      this.update();
    });
    const upright = input('upright');
    upright.checked = viewer.upright;
    upright.addEventListener('change', () => {
      viewer.upright = upright.checked;
      remember('upright', upright.checked);
    });
    this.fov.addEventListener('input', () => {
      viewer.fov = this.fov.valueAsNumber / degreesPerRadian;
      this.update();
    });
    viewer.on('scene', () => this.update());
    viewer.on('view', () => this.update());
    viewer.on('frame', () => this.showMode());  // keys change it too
    this.update();
  }

  setMode(mode: NavigationMode): void {
    this.viewer.mode = mode;
    this.showMode();
  }

  changeMode(): void { this.setMode(this.viewer.mode === 'orbit' ? 'fly' : 'orbit'); }

  lookFrom(view: NamedView): void {
    this.setMode('orbit');
    this.viewer.showNamedView(view);
  }

  frame(): void {
    this.setMode('orbit');
    this.viewer.frame();
  }

  first(): void {
    this.setMode('orbit');
    this.viewer.home();
    this.update();
  }

  nextUp(): void {
    const next = axes[(this.upIndex() + 1) % axes.length]!;
    this.viewer.setUp(next.axis);
    this.update();
    this.tell(`The up axis is now ${next.name}.`);
  }

  /** Splats of 3DGS often have y downwards. */
  turnOver(): void {
    const [x, y, z] = this.viewer.getView().up;
    this.viewer.setUp([-x, -y, -z]);
    this.update();
    this.tell('The scene is turned upside down.');
  }

  private upIndex(): number {
    const up = this.viewer.getView().up;
    return axes.findIndex(({ axis }) => isAxis(up, axis));
  }

  private update(): void {
    const index = this.upIndex();
    this.up.value = index < 0 ? 'own' : String(index);
    // The reason applies only to the scene's own axis.
    const { scene } = this.viewer;
    block('up-reason').textContent = scene && isAxis(this.viewer.getView().up, scene.up) ? scene.upReason : '';
    const degrees = this.viewer.fov * degreesPerRadian;
    this.fov.value = String(degrees);
    block('fov-text').textContent = `${degrees.toFixed(0)}°`;
    this.showMode();
  }

  private showMode(): void {
    const now = this.viewer.mode;
    for (const mode of this.modes) mode.checked = mode.value === now;
    const speed = now === 'orbit' ? '' :
      `Speed: ${this.viewer.speed.toPrecision(3)} units per second; change it with the wheel.`;
    const hint = block('speed');
    if (hint.textContent !== speed) hint.textContent = speed;
  }
}
