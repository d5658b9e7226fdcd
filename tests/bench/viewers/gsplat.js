// gsplat. It sorts in a worker, one job at a time.

import { Camera, Matrix3, PLYLoader, Quaternion, Scene, Vector3, WebGLRenderer } from 'gsplat';
import { until } from './until.js';

const minus = (a, b) => a.map((value, axis) => value - b[axis]);
const unit = (a) => a.map((value) => value / Math.hypot(...a));
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

export async function create({ canvas, width, height, url, camera: first }) {
  const renderer = new WebGLRenderer(canvas, []);  // without passes, so without its fade-in
  const scene = new Scene(), camera = new Camera();
  const focal = 0.5 * height / Math.tan(first.fov * Math.PI / 360);
  Object.assign(camera.data, { fx: focal, fy: focal, near: first.near, far: first.far });
  renderer.setSize(width, height);
  /** Its camera looks along z, with y down. */
  const setCamera = ({ eye, target, up }) => {
    const z = unit(minus(target, eye)), x = unit(cross(z, up)), y = cross(z, x);
    camera.position = new Vector3(...eye);
    camera.rotation = Quaternion.FromMatrix3(new Matrix3(...[0, 1, 2].flatMap((axis) => [x[axis], y[axis], z[axis]])));
    camera.update();
  };
  setCamera(first);
  await PLYLoader.LoadAsync(url, scene, () => {}, '', false);

  const program = renderer.renderProgram;
  let orders = 0, watched = null;
  const watch = () => {
    if (!program.worker || program.worker === watched) return;
    watched = program.worker;
    const listener = watched.onmessage;
    watched.onmessage = (event) => {
      listener.call(watched, event);
      if (event.data.depthIndex?.length) ++orders;
    };
  };
  const draw = () => {
    renderer.render(scene, camera);
    watch();
  };
  await until(() => {
    draw();
    const data = program.renderData;
    return orders > 0 && data && !data.updating && program.depthIndex.length > 0;
  });
  let sorted = '';
  return {
    gl: renderer.gl, setCamera, draw,
    orders: () => orders,
    async settle() {
      const viewProj = camera.data.viewProj.buffer, wanted = viewProj.join();
      if (wanted === sorted) return;  // the worker ignores an order that it has
      sorted = wanted;
      const before = orders;
      watched.postMessage({ viewProj });
      await until(() => orders > before, 400).catch(() => {});  // it also ignores a view that is nearly the same
    },
  };
}
