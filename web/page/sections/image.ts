// Saves the image as a file.

import type { Viewer } from '../../viewer/types.js';
import { button, make, saveFile, select } from '../../common/dom.js';

/** Title, width and height of each choice; 0 x 0 for the size on the page. */
const sizes: readonly (readonly [string, number, number])[] = [
  ['as shown', 0, 0], ['1280 × 720', 1280, 720], ['1920 × 1080', 1920, 1080],
  ['3840 × 2160', 3840, 2160], ['1024 × 1024', 1024, 1024], ['2048 × 2048', 2048, 2048],
];

/** A valid name for all file systems: the scene's name without its extension, and the debug view. */
export const imageName = (scene: string, debugView: string) =>
  fileName(scene, 'png', debugView === 'color' ? '' : `-${debugView}`);

export function fileName(scene: string, extension: string, more = ''): string {
  const stem = scene.replace(/\.[a-z0-9]{1,5}$/i, '').replace(/[^\p{L}\p{N}._-]+/gu, '-').replace(/^[-.]+|[-.]+$/g, '');
  return `${stem || 'tureen'}${more}.${extension}`;
}

export class ImageSection {
  private readonly size = select('image-size');

  constructor(private readonly viewer: Viewer, private readonly tell: (sentence: string) => void,
              private readonly failed: (what: unknown) => void) {
    this.size.append(...sizes.map(([text, width, height]) => make('option', { value: `${width}x${height}` }, text)));
    button('save-image').addEventListener('click', () => void this.save());
    button('quick-image').addEventListener('click', () => void this.save());
  }

  async save(): Promise<void> {
    const { viewer } = this;
    if (!viewer.scene) return this.tell('There is no image to save: open a scene first.');
    const [width = 0, height = 0] = this.size.value.split('x').map(Number);
    try {
      const png = await (width > 0 ? viewer.screenshot({ width, height }) : viewer.screenshot());
      const name = imageName(viewer.scene.name, viewer.debugView);
      saveFile(name, png);
      this.tell(`Saved as ${name}.`);
    } catch (error) {
      this.failed(error);
    }
  }
}
