// Our page's viewer. It sorts few splats in each frame and many in a worker; tiles are sorted in each frame.

import { createViewer } from '/tureen/viewer.js';
import { until } from './until.js';

export async function create({ canvas, url, options, camera: first }) {
  let draws = 0, sorted = 0, sorting = false;
  const Native = window.Worker;
  window.Worker = class extends Native {
    constructor(...given) {
      super(...given);
      this.addEventListener('message', ({ data }) => {
        if (data.kind !== 'sorted') return;
        ++sorted;
        sorting = false;
      });
    }
    postMessage(message, ...rest) {
      sorting ||= message.kind === 'sort';
      super.postMessage(message, ...rest);
    }
  };
  const source = { url };
  const viewer = await createViewer(canvas, {
    ...options, expected: source, controls: false, smoothAtRest: false, background: [0, 0, 0], chooseSplats: async ({ splats }) => splats,
  });
  await viewer.load(source);
  viewer.gliding = false;
  viewer.background = [0, 0, 0];
  window.requestAnimationFrame = () => 1;  // only the benchmark draws

  const setCamera = ({ eye, target, up, fov }) => viewer.setView({ eye, target, up, fov: fov * Math.PI / 180, roll: 0 });
  const draw = () => {
    viewer.draw();
    ++draws;
  };
  setCamera(first);
  return {
    gl: canvas.getContext('webgl2'), setCamera, draw,
    orders: () => sorted || draws,
    async settle() {
      draw();  // sends the worker's task
      await new Promise((resolve) => setTimeout(resolve));
      await until(() => !sorting);
    },
  };
}
