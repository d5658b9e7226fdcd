// The form with the settings. The page's address sets the initial values.

import { attachPicker, block, button, byId, input, make, select } from '../common/dom.js';
import type { Messages } from '../common/messages.js';
import { ViewerError } from '../viewer/types.js';
import {
  countOf, most, sizeKey, sizesOf, sizeText, type AddressRequest, type BenchRequest, type CameraChoice, type Size,
} from './request.js';
import { SceneList } from './scene_list.js';

const usualSizes: readonly Size[] = [
  { width: 640, height: 360 }, { width: 1280, height: 720 }, { width: 1920, height: 1080 }, { width: 3840, height: 2160 },
];

const cameraHints: Readonly<Record<CameraChoice['kind'], string>> = {
  hemisphere: 'Cameras at even distances on the upper half of a sphere around the scene (Fibonacci).',
  orbit: 'Cameras on a circle around the scene, looking slightly downwards.',
  recorded: 'The first cameras in the scene’s file, usually those of its photographs.',
  file: 'A camera path (cameras evenly in time), or a list of cameras from Tureen or a transforms.json (the first ones).',
};

export class Settings {
  private readonly form = byId('settings', HTMLFormElement);
  private readonly scenes: SceneList;
  private readonly sizes: { size: Size; box: HTMLInputElement }[] = [];
  private cameraFile: { name: string; text: string } | null = null;

  /** `refused`: receives the error of an invalid request. */
  constructor(private readonly messages: Messages, private readonly begin: (request: BenchRequest) => void,
              private readonly refused: (why: unknown) => void) {
    this.scenes = new SceneList(messages);
    this.form.noValidate = true;  // our messages are more precise
    this.form.addEventListener('submit', (event) => {
      event.preventDefault();
      this.submit();
    });
    for (const id of ['grid', 'camera-kind']) byId(id, HTMLElement).addEventListener('change', () => this.follow());
    attachPicker('choose-camera-file', 'camera-file', async ([file]) => {
      this.cameraFile = { name: file!.name, text: await file!.text() };
      block('camera-file-name').textContent = file!.name;
    });
  }

  /** Sets the initial values; called once. */
  async fill(asked: AddressRequest): Promise<void> {
    input('grid').checked = asked.grid;
    input('copies').value = String(asked.copies);
    select('camera-kind').value = asked.set.kind;
    input('camera-count').value = String(asked.set.count);
    input('rounds').value = String(asked.rounds);
    input('published').checked = asked.published;
    this.fillSizes(asked.sizes.length ? asked.sizes : [usualSizes[1]!]);
    this.follow();
    await this.scenes.fill(asked.scenes);
  }

  /** Whether the engine is ready. */
  set ready(ready: boolean) { button('run').disabled = !ready; }

  submit(): void {
    this.messages.clearErrors();
    let request;
    try {
      request = this.request();
    } catch (error) {
      return this.refused(error);
    }
    this.begin(request);
  }

  /** Disables the form during a measurement. */
  set busy(busy: boolean) {
    for (const part of this.form.querySelectorAll('fieldset')) part.disabled = busy;
    button('run').disabled = busy;
  }

  /** Throws ViewerError. */
  private request(): BenchRequest {
    const scenes = this.scenes.chosen, grid = input('grid').checked;
    if (scenes.length === 0) throw new ViewerError('No scene is selected: choose or add one.', 'usage');
    const sizes = new Map([...this.sizes.filter(({ box }) => box.checked).map(({ size }) => size),
                           ...sizesOf(input('other-sizes').value)].map((size) => [sizeKey(size), size]));
    if (sizes.size === 0) throw new ViewerError('No image size is selected: choose one.', 'usage');
    return {
      scenes, grid, cameras: this.cameras(), sizes: [...sizes.values()],
      copies: countOf(input('copies').value, 'copies', most.copies),
      rounds: countOf(input('rounds').value, 'rounds', most.rounds),
      published: !grid && input('published').checked,
    };
  }

  private cameras(): CameraChoice {
    const kind = select('camera-kind').value as CameraChoice['kind'];
    const count = countOf(input('camera-count').value, 'cameras', most.views);
    if (kind !== 'file') return { kind, count };
    if (!this.cameraFile) throw new ViewerError('No camera file is selected: choose one.', 'usage');
    return { kind, count, ...this.cameraFile };
  }

  /** Lists the usual sizes, the screen's size and those of the address. */
  private fillSizes(asked: readonly Size[]): void {
    const own = { width: Math.round(screen.width * devicePixelRatio), height: Math.round(screen.height * devicePixelRatio) };
    const all = new Map([...usualSizes, own, ...asked].map((size) => [sizeKey(size), size]));
    for (const [key, size] of [...all].sort(([, a], [, b]) => a.width * a.height - b.width * b.height)) {
      const box = make('input', { type: 'checkbox' });
      box.checked = asked.some((one) => sizeKey(one) === key);
      block('sizes').append(make('label', { class: 'check' }, box,
        make('span', { title: key === sizeKey(own) ? 'This screen' : null }, sizeText(size))));
      this.sizes.push({ size, box });
    }
  }

  private follow(): void {
    const kind = select('camera-kind').value as CameraChoice['kind'], grid = input('grid').checked;
    block('camera-hint').textContent = cameraHints[kind];
    block('camera-file-part').hidden = kind !== 'file';
    block('copies-field').hidden = !grid;
    input('published').disabled = grid;  // a grid has no baseline
  }
}
