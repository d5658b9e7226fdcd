// Saves the scene as a file: a worker reads its sources again and writes.

import { writtenFormats, type Viewer, type WrittenFormat } from '../../viewer/types.js';
import { button, make, saveFile, select } from '../../common/dom.js';
import type { Loading } from '../loading.js';
import { fileName } from './image.js';

const titles: Readonly<Record<WrittenFormat, string>> = {
  glb: 'GLB, exact', ply: 'PLY, for other programs', html: 'HTML, this page with the scene',
};

export class DownloadSection {
  constructor(viewer: Viewer, loading: Loading, tell: (sentence: string) => void) {
    const format = select('download-format');
    format.append(...writtenFormats.map((value) => make('option', { value }, titles[value])));
    button('download').addEventListener('click', () => {
      const kind = writtenFormats[format.selectedIndex]!, name = viewer.scene && fileName(viewer.scene.name, kind);
      if (!name) return tell('There is no scene to save: open one first.');
      void loading.write(name, async (signal) => {
        const { file, losses } = await viewer.write(kind, { signal });
        saveFile(name, file);
        tell([`Saved as ${name}.`, ...losses.map((loss) => `Lost: ${loss.replace(/\.$/, '')}.`)].join(' '));
      });
    });
  }
}
