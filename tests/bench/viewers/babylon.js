// @babylonjs/core, with the splat loader of @babylonjs/loaders. It sorts in a worker, one job at a time.

import { FreeCamera } from '@babylonjs/core/Cameras/freeCamera.js';
import { Engine } from '@babylonjs/core/Engines/engine.js';
import '@babylonjs/core/Loading/loadingScreen.js';
import { AppendSceneAsync } from '@babylonjs/core/Loading/sceneLoader.js';
import { Color4 } from '@babylonjs/core/Maths/math.color.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { GaussianSplattingMesh } from '@babylonjs/core/Meshes/GaussianSplatting/gaussianSplattingMesh.js';
import { Scene } from '@babylonjs/core/scene.js';
import '@babylonjs/loaders/SPLAT/splatFileLoader.js';
import { until } from './until.js';

export async function create({ canvas, url, camera: first }) {
  const engine = new Engine(canvas, false, { stencil: false, adaptToDeviceRatio: false }, false);
  engine.loadingScreen = { displayLoadingUI() {}, hideLoadingUI() {} };
  const scene = new Scene(engine);
  scene.useRightHandedSystem = true;
  scene.clearColor = new Color4(0, 0, 0, 1);
  const camera = new FreeCamera('camera', new Vector3(...first.eye), scene);
  Object.assign(camera, { fov: first.fov * Math.PI / 180, minZ: first.near, maxZ: first.far });
  scene.activeCamera = camera;
  const setCamera = ({ eye, target, up }) => {
    camera.upVector = new Vector3(...up);
    camera.position = new Vector3(...eye);
    camera.setTarget(new Vector3(...target));
    camera.getViewMatrix(true);
  };
  setCamera(first);
  await AppendSceneAsync(location.origin + url, scene);
  const mesh = scene.meshes.find((each) => each instanceof GaussianSplattingMesh);
  mesh.scaling.set(1, 1, 1);  // the loader mirrors y

  let orders = 0, watched = null;
  const watch = () => {
    const worker = mesh._worker;
    if (!worker || worker === watched) return;
    watched = worker;
    const listener = worker.onmessage;
    worker.onmessage = (event) => {
      listener.call(worker, event);
      ++orders;
    };
  };
  const draw = () => {
    watch();
    engine.beginFrame();
    scene.render();
    engine.endFrame();
  };
  await until(() => {
    draw();
    return mesh._readyToDisplay && scene.isReady();
  });
  return {
    gl: engine._gl, setCamera, draw,
    orders: () => orders,
    async settle() {
      watch();
      await until(() => mesh._canPostToWorker);
      const before = orders;
      scene.incrementRenderId();
      camera.getViewMatrix(true);
      mesh._postToWorker(true);
      await until(() => orders > before && mesh._canPostToWorker);
    },
  };
}
